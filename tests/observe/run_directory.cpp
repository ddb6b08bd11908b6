// SPDX-License-Identifier: BSD-3-Clause

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <lacuna/observe/run_directory.hpp>
#include <lacuna/observe/stop_signal.hpp>

#include "catch.hpp"
#include "scratch_directory.hpp"

namespace {

using lacuna::earlier_results;

std::vector<std::string> const known{"summary.json", "frame-#.vtp", "log-a"};

std::unique_ptr<lacuna::run_directory> open_directory(std::string const& path,
                                                      earlier_results earlier = earlier_results::refuse) {
    return std::make_unique<lacuna::run_directory>(path, "output.directory", known, earlier);
}
std::string refusal(std::string const& path, earlier_results earlier = earlier_results::refuse) {
    try {
        open_directory(path, earlier);
    } catch (std::invalid_argument const& e) {
        return e.what();
    }
    return "accepted";
}
void write(std::string const& path, std::string const& text = "x") { std::ofstream(path, std::ios::binary) << text; }

/// Runs work() in another process. Returns the number of the process when work() is done.
template <class Work>
pid_t in_another_process(Work work) {
    int ready[2];
    REQUIRE(pipe(ready) == 0);
    pid_t const child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        auto const held = work();
        (void)!::write(ready[1], "r", 1);
        for (;;) pause();
    }
    char byte = 0;
    close(ready[1]);
    REQUIRE(read(ready[0], &byte, 1) == 1);
    close(ready[0]);
    return child;
}
void end(pid_t child) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
}

} // namespace

TEST_CASE("a directory has one owner, which is named, and none after that has ended", "[directory]") {
    scratch_directory const dir;
    pid_t const owner = in_another_process([&] { return open_directory(dir.path.string()); });
    for (auto const earlier : {earlier_results::refuse, earlier_results::replace, earlier_results::keep})
        CHECK_THAT(refusal(dir.path.string(), earlier),
                   contains_text("output.directory = ") && contains_text("in use by process " + std::to_string(owner)));
    // A killed owner leaves the file, but not the lock.
    end(owner);
    REQUIRE(std::filesystem::exists(dir.path / "lacuna.lock"));
    open_directory(dir.path.string());
    REQUIRE(dir.entries() == 0);
    // Two owners in one process exclude each other, too.
    auto const first = open_directory(dir.path.string());
    REQUIRE_THAT(refusal(dir.path.string()), contains_text("in use by process " + std::to_string(getpid())));
}

TEST_CASE("if many processes open a directory at the same instant, one gets it", "[directory]") {
    scratch_directory const dir;
    for (int round = 0; round < 10; ++round) {
        std::string const path = dir.file("out") + std::to_string(round);
        if (round % 2 == 1) {
            std::filesystem::create_directory(path);
            write(path + "/lacuna.lock", "999999 1 nowhere\n");
        }
        int start[2], done[2];
        REQUIRE(pipe(start) == 0);
        REQUIRE(pipe(done) == 0);
        std::vector<pid_t> children;
        for (int k = 0; k < 8; ++k) {
            children.push_back(fork());
            if (children.back() != 0) continue;
            close(start[1]);
            char byte;
            (void)!read(start[0], &byte, 1);
            std::unique_ptr<lacuna::run_directory> mine;
            try {
                mine = open_directory(path);
            } catch (std::invalid_argument const&) {
            }
            (void)!::write(done[1], mine ? "1" : "0", 1);
            for (;;) pause();
        }
        close(start[0]);
        close(start[1]);
        int winners = 0;
        for (int k = 0; k < 8; ++k) {
            char byte = 0;
            REQUIRE(read(done[0], &byte, 1) == 1);
            winners += byte == '1';
        }
        for (pid_t const child : children) end(child);
        close(done[0]);
        close(done[1]);
        REQUIRE(winners == 1);
    }
}

TEST_CASE("the lock file shows whether its owner still runs", "[directory]") {
    auto const self = lacuna::lock_owner::self();
    auto const read_back = lacuna::lock_owner::from(self.text());
    REQUIRE(read_back.process == getpid());
    REQUIRE(read_back.started == self.started);
    REQUIRE(read_back.host == self.host);
    REQUIRE(self.may_run());
    auto later = self;
    if (!self.started.empty()) {
        later.started = std::to_string(std::stoll(self.started) - 1); // an earlier process with our number
        REQUIRE_FALSE(later.may_run());
    }
    pid_t const child = fork();
    if (child == 0) _exit(0);
    waitpid(child, nullptr, 0);
    auto dead = self;
    dead.process = child;
    REQUIRE_FALSE(dead.may_run());
    auto elsewhere = dead;
    elsewhere.host = "another-" + self.host;
    REQUIRE(elsewhere.may_run());
    REQUIRE_FALSE(lacuna::lock_owner::from("").may_run());
    REQUIRE_FALSE(lacuna::lock_owner::from("of a person\n").may_run());
}

TEST_CASE("results of an earlier run are refused, replaced or kept, other files stay", "[directory]") {
    scratch_directory const dir;
    std::vector<std::string> const foreign{"frame-.vtp", "frame-1a.vtp",          "frame-12.vtu",   "xframe-12.vtp",
                                           "log-b",      "summary.json.part.old", "notes.txt.part", "other.7-1.part"};
    for (auto const& name : foreign) write(dir.file(name));
    for (char const* result : {"summary.json", "frame-000000000012.vtp", "log-a"}) {
        write(dir.file(result));
        CHECK_THAT(refusal(dir.path.string()),
                   contains_text(std::string("it holds ") + result) && contains_text("--force"));
        CHECK(dir.entries() == foreign.size() + 1);
        open_directory(dir.path.string(), earlier_results::keep)->keep();
        CHECK(std::filesystem::exists(dir.file(result)));
        {
            auto const mine = open_directory(dir.path.string(), earlier_results::replace);
            CHECK(std::filesystem::exists(dir.file(result))); // it has not begun yet
            mine->keep();
            CHECK_FALSE(std::filesystem::exists(dir.file(result)));
        }
    }
    // Temporary files of results are removed, whichever way they are named.
    for (char const* part : {"summary.json.part", "frame-7.vtp.part", "frame-7.vtp.4321-9.part"}) write(dir.file(part));
    open_directory(dir.path.string())->keep();
    CHECK(dir.entries() == foreign.size());
    for (auto const& name : foreign) CHECK(std::filesystem::exists(dir.file(name)));
}

TEST_CASE("directories that were created for nothing are removed again", "[directory]") {
    scratch_directory const dir;
    open_directory(dir.file("a/b/c"));
    REQUIRE(dir.entries() == 0);
    write(dir.file("file"));
    REQUIRE_THAT(refusal(dir.file("file")), contains_text("must be a directory"));
    REQUIRE_THAT(refusal(dir.file("file/inside")), contains_text("must be a directory"));
    REQUIRE(dir.entries() == 1);
    {
        auto const made = open_directory(dir.file("a/b"));
        made->keep();
        write(made->file("log-a"));
        made->discard();
    }
    REQUIRE(dir.entries() == 1);
    open_directory(dir.file("a/b/c"))->keep();
    REQUIRE(std::filesystem::is_directory(dir.path / "a/b/c"));
}

TEST_CASE("two writers of one file do not disturb each other, and the file of a killed one is overwritten",
          "[directory]") {
    scratch_directory const dir;
    std::string const path = dir.file("result");
    {
        lacuna::whole_file slow(path);
        slow.write("slow");
        lacuna::whole_file quick(path);
        quick.write("quick");
        quick.commit();
        CHECK(bytes_of(path) == "quick");
        lacuna::whole_file given_up(path);
        given_up.write("nothing");
        slow.commit();
        CHECK(bytes_of(path) == "slow");
    }
    REQUIRE(dir.entries() == 1);
    pid_t const writer = in_another_process([&] {
        auto file = std::make_unique<lacuna::whole_file>(path);
        file->write("a long text that is not whole");
        std::fflush(file->handle());
        return file;
    });
    end(writer);
    REQUIRE(dir.entries() == 2);
    lacuna::whole_file next(path);
    next.write("next");
    next.commit();
    REQUIRE(bytes_of(path) == "next");
    REQUIRE(dir.entries() == 1);
}

TEST_CASE("a signal is a request, another one more than a second later ends the program", "[directory]") {
    // 0: no more signals, 1: another at once, 2: another after more than a second
    for (int const more : {0, 1, 2}) {
        pid_t const child = fork();
        if (child == 0) {
            lacuna::watch_stop_signals();
            raise(SIGPIPE);
            raise(SIGTERM);
            if (more == 1) raise(SIGINT);
            if (more == 2) {
                lacuna::detail::stop_signal_time = lacuna::detail::stop_signal_time - 1001;
                raise(SIGINT);
            }
            _exit(lacuna::stop_signal() == SIGTERM ? 7 : 8);
        }
        int status = 0;
        REQUIRE(waitpid(child, &status, 0) == child);
        if (more < 2)
            CHECK((WIFEXITED(status) && WEXITSTATUS(status) == 7));
        else
            CHECK((WIFSIGNALED(status) && WTERMSIG(status) == SIGINT));
    }
    REQUIRE(lacuna::signal_name(SIGTERM) == "SIGTERM");
}
