// SPDX-License-Identifier: BSD-3-Clause

#include <fstream>
#include <string>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <lacuna/observe/vtk_collection.hpp>

#include "catch.hpp"
#include "scratch_directory.hpp"

TEST_CASE("a growing file is cut back to a mark and continues", "[growing]") {
    scratch_directory const dir;
    std::string const path = dir.file("log.csv");
    lacuna::growing_file log(path, "a,b\n");
    log.begin();
    REQUIRE(bytes_of(path) == "a,b\n");
    log.add("1,2\n");
    log.flush();
    auto const mark = log.mark();
    REQUIRE(mark.bytes == 8);
    log.add("3,4\n");
    log.sync();
    REQUIRE(bytes_of(path) == "a,b\n1,2\n3,4\n");

    lacuna::growing_file again(path, "a,b\n");
    again.resume(mark);
    again.add("5,6\n");
    again.flush();
    REQUIRE(bytes_of(path) == "a,b\n1,2\n5,6\n");
    // The same text has the same mark, in whatever pieces it was added.
    lacuna::growing_file other(dir.file("other.csv"), "a,b\n");
    other.begin();
    other.add("1,2\n5,6\n");
    other.flush();
    REQUIRE(other.mark() == again.mark());

    again.resume({});
    REQUIRE_FALSE(std::filesystem::exists(path));
}

TEST_CASE("a growing file whose beginning does not fit the mark is refused and not changed", "[growing]") {
    scratch_directory const dir;
    std::string const path = dir.file("log.csv");
    lacuna::growing_file log(path, "head\n");
    log.begin();
    log.add("1\n2\n");
    log.flush();
    auto const mark = log.mark();
    for (std::string const text : {"", "head\n1\n", "head\n1\n3\n4\n"}) {
        std::ofstream(path, std::ios::binary) << text;
        REQUIRE_THROWS_WITH(lacuna::growing_file(path, "head\n").resume(mark), contains_text(path));
        REQUIRE(bytes_of(path) == text);
    }
    std::filesystem::remove(path);
    REQUIRE_THROWS_WITH(lacuna::growing_file(path, "head\n").resume(mark), contains_text(path));
}

TEST_CASE("lines are written together, when thousands of bytes wait", "[growing]") {
    scratch_directory const dir;
    std::string const path = dir.file("log");
    lacuna::growing_file log(path, "h\n");
    log.begin();
    std::string const line(99, 'x');
    std::size_t before = 2, writes = 0;
    for (int k = 0; k < 2000; ++k) {
        log.add(line + "\n");
        std::size_t const size = std::filesystem::file_size(path);
        REQUIRE((size - 2) % 100 == 0);
        writes += size != before;
        before = size;
    }
    REQUIRE(writes > 10);
    REQUIRE(writes < 200); // even if the machine is so slow that a second passes now and then
    log.flush();
    REQUIRE(std::filesystem::file_size(path) == 200002);
}

TEST_CASE("a full disk leaves whole lines and an error message", "[growing]") {
    scratch_directory const dir;
    for (bool const closed : {false, true}) {
        std::string const path = dir.file(closed ? "log.pvd" : "log.csv"), foot = closed ? "</end>\n" : "";
        pid_t const child = fork();
        if (child == 0) {
            rlimit const limit{5000, 5000};
            signal(SIGXFSZ, SIG_IGN);
            setrlimit(RLIMIT_FSIZE, &limit);
            int status = 1;
            try {
                lacuna::growing_file log(path, "head\n", foot);
                log.begin();
                for (int k = 0; k < 100; ++k) {
                    log.add(std::string(98, 'x') + "\n");
                    log.flush();
                }
            } catch (std::runtime_error const& e) {
                status = std::string(e.what()).find(path) != std::string::npos ? 7 : 8;
            }
            _exit(status);
        }
        int status = 0;
        REQUIRE(waitpid(child, &status, 0) == child);
        REQUIRE(WEXITSTATUS(status) == 7);
        std::string text = "head\n";
        for (int k = 0; text.size() + 99 + foot.size() <= 5000; ++k) text += std::string(98, 'x') + "\n";
        REQUIRE(bytes_of(path) == text + foot);
    }
}

TEST_CASE("a collection is complete after each frame and can be cut back to a time", "[growing][vtk]") {
    scratch_directory const dir;
    std::string const path = dir.file("run.pvd"),
                      head = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
    auto const entry = [](std::string const& time) {
        return "<DataSet timestep=\"" + time + "\" file=\"f-" + time + ".vtp\"/>\n";
    };
    std::string const foot = "</Collection>\n</VTKFile>\n";
    auto series = lacuna::vtk_collection(path);
    series.begin();
    std::string text = head;
    for (double const time : {0.0, 0.1, 0.25, 1e-3 + 1, 2.5}) {
        series.add(lacuna::vtk_collection_entry(time, "f-" + lacuna::to_text(time) + ".vtp"));
        series.flush();
        text += entry(lacuna::to_text(time));
        REQUIRE(bytes_of(path) == text + foot);
    }
    auto const [none, never] = lacuna::vtk_collection_until(path, -1);
    REQUIRE(none.bytes == 0);
    REQUIRE(lacuna::vtk_collection_until(dir.file("missing.pvd"), 1).first.bytes == 0);
    auto const [mark, last] = lacuna::vtk_collection_until(path, 0.25);
    REQUIRE(last == 0.25);
    auto again = lacuna::vtk_collection(path);
    again.resume(mark);
    text = head + entry("0") + entry("0.1") + entry("0.25");
    REQUIRE(bytes_of(path) == text + foot);
    again.add(lacuna::vtk_collection_entry(0.3, "f-0.3.vtp"));
    again.flush();
    REQUIRE(bytes_of(path) == text + entry("0.3") + foot);
}
