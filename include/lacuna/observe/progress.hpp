// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>

#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

#include <lacuna/core/error.hpp>
#include <lacuna/core/text.hpp>

namespace lacuna {

/// A duration in seconds as readable text: "8 s", "3:05", "2:07:09".
inline std::string clock_text(double seconds) {
    if (!std::isfinite(seconds) || seconds < 0 || seconds > 359999) return "?";
    long const whole = std::lround(std::ceil(seconds));
    char buffer[32];
    if (whole < 60)
        std::snprintf(buffer, sizeof buffer, "%ld s", whole);
    else if (whole < 3600)
        std::snprintf(buffer, sizeof buffer, "%ld:%02ld", whole / 60, whole % 60);
    else
        std::snprintf(buffer, sizeof buffer, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
    return buffer;
}

/// A number with three digits and an SI prefix: 12340000 -> "12.3 M", 12 -> "12".
inline std::string rate_text(double rate) {
    struct magnitude {
        double size;
        char const* letter;
    };
    for (magnitude const m : {magnitude{1e9, "G"}, magnitude{1e6, "M"}, magnitude{1e3, "k"}})
        if (rate >= m.size) return formatted("%.3g ", rate / m.size) + m.letter;
    return formatted("%.3g", rate);
}

/// True if a file is a terminal, on which a line can be rewritten.
inline bool is_terminal(std::FILE* file) noexcept {
#if __has_include(<unistd.h>)
    return file != nullptr && isatty(fileno(file)) == 1;
#else
    return false;
#endif
}

/// Options of a progress reporter: the size of the run and the frequency of reports.
struct progress_options {
    std::FILE* sink = nullptr;    ///< receives the reports; null: there are none
    long long steps = 1;          ///< steps of the whole run
    long long particles = 1;      ///< for the rate, which counts particles times steps
    char const* unit = "particle-steps"; ///< unit of the rate, counted per second; null: no rate
    bool terminal = false;        ///< true: rewrite one line (see is_terminal()); false: write plain lines
    double refresh_seconds = 0.1; ///< least time between two rewrites, s
    double line_seconds = 5;      ///< least time between two plain lines, s
    int bar_width = 20;           ///< width of the bar, characters

    /// \throws std::invalid_argument that names the field
    void validate() const {
        if (steps < 1) refuse("progress_options.steps", double(steps), ">= 1");
        if (particles < 1) refuse("progress_options.particles", double(particles), ">= 1");
        require_not_negative("progress_options.refresh_seconds", refresh_seconds);
        require_not_negative("progress_options.line_seconds", line_seconds);
        require_in("progress_options.bar_width", bar_width, 1, 200);
    }
};

/// Reports the progress of a run: percent, rate and time left. On a terminal it rewrites a bar in place; elsewhere it
/// writes plain lines. It writes only to the sink that the program passes.
/// \tparam Clock a clock of std::chrono; a test has its own
template <class Clock = std::chrono::steady_clock>
class progress_reporter {
public:
    /// Starts the clock. \throws std::invalid_argument for options out of range
    explicit progress_reporter(progress_options const& options)
        : options_(options), start_(Clock::now()), last_(start_) {
        options_.validate();
    }
    progress_reporter(progress_reporter const&) = delete;
    progress_reporter& operator=(progress_reporter const&) = delete;
    /// Ends the line on a terminal.
    ~progress_reporter() { end_line(); }

    /// Changes the number of steps of the whole run, for runs whose end is not known at the start.
    /// \throws std::invalid_argument for less than 1
    void expect(long long steps) {
        if (steps < 1) refuse("steps of the whole run", double(steps), ">= 1");
        options_.steps = steps;
    }
    /// Reports that `step` steps are done, with `note` at the end of the line. Cheap if the next report is not due yet.
    void update(long long step, std::string_view note = {}) {
        if (options_.sink == nullptr) return;
        auto const now = Clock::now();
        double const since = seconds(now - last_);
        if (since < (options_.terminal ? options_.refresh_seconds : options_.line_seconds)) return;
        last_ = now;
        write(step, seconds(now - start_), note);
    }
    /// Writes the last report, whether it is due or not. Later calls do nothing.
    void finish(long long step, std::string_view note = {}) {
        if (options_.sink == nullptr || finished_) return;
        finished_ = true;
        write(step, seconds(Clock::now() - start_), note);
        end_line();
    }

private:
    static double seconds(typename Clock::duration d) { return std::chrono::duration<double>(d).count(); }

    void write(long long step, double elapsed, std::string_view note) {
        double const share = std::clamp(double(step) / double(options_.steps), 0.0, 1.0);
        double const rate = elapsed > 0 ? double(step) * double(options_.particles) / elapsed : 0;
        double const left = share > 0 ? elapsed * (1 - share) / share : -1;
        char head[32];
        std::snprintf(head, sizeof head, "%3d %%", int(100 * share));
        std::string line;
        if (options_.terminal) {
            int const full = int(share * options_.bar_width);
            line = "\r[" + std::string(std::size_t(full), '=');
            if (full < options_.bar_width) line += '>';
            line.resize(std::size_t(options_.bar_width) + 2, ' ');
            line += "] ";
        }
        line += head;
        if (options_.unit != nullptr) line += "  " + rate_text(rate) + " " + options_.unit + "/s";
        line += finished_ ? "  took " + clock_text(elapsed) : "  left " + clock_text(left);
        if (!note.empty()) line += "  " + std::string(note);
        // Blanks cover the rest of a longer previous line on the terminal.
        std::size_t const length = line.size();
        if (options_.terminal && length < longest_) line.append(longest_ - length, ' ');
        longest_ = std::max(longest_, length);
        if (!options_.terminal) line += '\n';
        std::fputs(line.c_str(), options_.sink);
        std::fflush(options_.sink);
        open_line_ = options_.terminal;
    }
    void end_line() {
        if (!open_line_) return;
        std::fputc('\n', options_.sink);
        std::fflush(options_.sink);
        open_line_ = false;
    }

    progress_options options_;
    typename Clock::time_point start_;
    typename Clock::time_point last_;
    std::size_t longest_ = 0;
    bool open_line_ = false;
    bool finished_ = false;
};

} // namespace lacuna
