// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <lacuna/observe/progress.hpp>

#include <cstdio>
#include <string>

namespace {

/// A clock that stands still until the test moves it.
struct hand_clock {
    using duration = std::chrono::nanoseconds;
    using rep = duration::rep;
    using period = duration::period;
    using time_point = std::chrono::time_point<hand_clock>;
    static time_point now() { return time_point(time); }
    static void advance(double seconds) { time += duration(rep(seconds * 1e9)); }
    static inline duration time{0};
};

/// A temporary file that is removed at the end.
struct scratch_file {
    std::FILE* file = std::tmpfile();
    ~scratch_file() { std::fclose(file); }
    std::string text() const {
        std::string result;
        std::rewind(file);
        for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) result += char(c);
        return result;
    }
};

} // namespace

TEST_CASE("clock and rate texts") {
    CHECK(lacuna::clock_text(0) == "0 s");
    CHECK(lacuna::clock_text(7.2) == "8 s");
    CHECK(lacuna::clock_text(185) == "3:05");
    CHECK(lacuna::clock_text(7629) == "2:07:09");
    CHECK(lacuna::clock_text(-1) == "?");
    CHECK(lacuna::clock_text(INFINITY) == "?");
    CHECK(lacuna::rate_text(12340000) == "12.3 M");
    CHECK(lacuna::rate_text(1.5e9) == "1.5 G");
    CHECK(lacuna::rate_text(2000) == "2 k");
    CHECK(lacuna::rate_text(12) == "12");
}

TEST_CASE("plain lines have percent, rate and time left, at intervals") {
    scratch_file out;
    lacuna::progress_options options;
    options.sink = out.file;
    options.steps = 1000;
    options.particles = 400;
    options.line_seconds = 5;
    {
        lacuna::progress_reporter<hand_clock> progress(options);
        hand_clock::advance(2);
        progress.update(100, "too early");
        CHECK(out.text().empty());
        hand_clock::advance(8);
        progress.update(250, "broken 3");
        hand_clock::advance(4);
        progress.update(300, "too early again");
    }
    // 250 * 400 / 10 s; three quarters are left after 10 s.
    CHECK(out.text() == " 25 %  10 k particle-steps/s  left 30 s  broken 3\n");
}

TEST_CASE("a run whose length changes while it runs") {
    scratch_file out;
    lacuna::progress_options options;
    options.sink = out.file;
    options.steps = 1000;
    options.line_seconds = 5;
    lacuna::progress_reporter<hand_clock> progress(options);
    hand_clock::advance(10);
    progress.expect(200);
    progress.update(50);
    CHECK(out.text() == " 25 %  5 particle-steps/s  left 30 s\n");
    CHECK_THROWS_WITH(progress.expect(0), contains_text("steps of the whole run = 0"));
}

TEST_CASE("the last line is always written, once") {
    scratch_file out;
    lacuna::progress_options options;
    options.sink = out.file;
    options.steps = 10;
    lacuna::progress_reporter<hand_clock> progress(options);
    hand_clock::advance(1);
    progress.finish(5, "interrupted");
    progress.finish(5, "interrupted");
    CHECK(out.text() == " 50 %  5 particle-steps/s  took 1 s  interrupted\n");
}

TEST_CASE("on a terminal one line is rewritten, and blanks cover the rest of a longer one") {
    scratch_file out;
    lacuna::progress_options options;
    options.sink = out.file;
    options.steps = 10;
    options.terminal = true;
    options.bar_width = 4;
    lacuna::progress_reporter<hand_clock> progress(options);
    hand_clock::advance(1);
    progress.update(5, "a long note");
    hand_clock::advance(1);
    progress.finish(10);
    std::string const text = out.text();
    std::size_t const second = text.rfind('\r');
    REQUIRE(second != std::string::npos);
    CHECK(text.substr(0, 7) == "\r[==> ]");
    CHECK(text.substr(second, 7) == "\r[====]");
    CHECK(text.size() - 1 - second == second);
    CHECK(text.back() == '\n');
    CHECK(text.find('\n') == text.size() - 1);
}

TEST_CASE("without a sink nothing is written, and bad options are refused") {
    lacuna::progress_reporter<hand_clock> silent(lacuna::progress_options{});
    silent.update(1);
    silent.finish(1);
    lacuna::progress_options none;
    none.steps = 0;
    CHECK_THROWS_WITH(lacuna::progress_reporter<>(none), contains_text("progress_options.steps"));
    lacuna::progress_options empty;
    empty.particles = 0;
    CHECK_THROWS_WITH(lacuna::progress_reporter<>(empty), contains_text("progress_options.particles"));
}
