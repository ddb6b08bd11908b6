// SPDX-License-Identifier: BSD-3-Clause
//
// on_terminal there|there_alone SCRATCH PROGRAM WORDS...: runs a program on a pseudo terminal until it shows its
// progress, stops it, and checks its output. With `there_alone` it also checks that the program shows no progress when
// its output is not a terminal. The words start a run of hours, with results in `out`.

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "kill/process.hpp"

#include <cstdlib>
#include <sys/ioctl.h>

namespace {

using process::fs::path;

void require(bool holds, std::string const& what) {
    if (!holds) throw std::runtime_error(what);
}

/// A program whose output is a terminal.
class on_terminal {
public:
    on_terminal(std::vector<std::string> const& words, path const& folder)
        : terminal_(posix_openpt(O_RDWR | O_NOCTTY)) {
        require(terminal_ >= 0 && grantpt(terminal_) == 0 && unlockpt(terminal_) == 0, "no pseudo terminal");
        std::string const name = ptsname(terminal_);
        child_ = fork();
        require(child_ >= 0, "cannot fork");
        if (child_ > 0) return;
        int const side = open(name.c_str(), O_RDWR | O_NOCTTY);
        std::vector<char*> arguments;
        for (auto const& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        if (chdir(folder.c_str()) != 0 || dup2(side, 1) < 0 || dup2(side, 2) < 0) _exit(126);
        close(side);
        close(terminal_);
        execv(arguments[0], arguments.data());
        _exit(127);
    }
    on_terminal(on_terminal const&) = delete;
    on_terminal& operator=(on_terminal const&) = delete;
    ~on_terminal() {
        if (child_ > 0) {
            kill(child_, SIGKILL);
            waitpid(child_, nullptr, 0);
        }
        close(terminal_);
    }
    /// Reads more of its output. \return false if it has ended
    bool read_on() {
        char buffer[4096];
        auto const got = read(terminal_, buffer, sizeof buffer);
        if (got > 0) text_.append(buffer, std::size_t(got));
        return got > 0;
    }
    std::string const& text() const { return text_; }
    void stop() const { kill(child_, SIGTERM); }
    int wait() {
        int status = 0;
        require(waitpid(child_, &status, 0) == child_, "cannot wait");
        child_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

private:
    int terminal_;
    pid_t child_ = 0;
    std::string text_;
};

/// True if a text has a line that is rewritten in place, such as "\r[==>  ]  12 %  3.4 M particle-steps/s  left 5 s".
bool shows_progress(std::string const& all) {
    for (auto at = all.find("\r["); at != all.npos; at = all.find("\r[", at + 1)) {
        auto end = at + 2;
        auto const skip = [&](char const* allowed) {
            auto const from = end;
            end = std::min(all.find_first_not_of(allowed, end), all.size());
            return end > from;
        };
        auto const take = [&](std::string const& word) {
            bool const found = all.compare(end, word.size(), word) == 0;
            end += found ? word.size() : 0;
            return found;
        };
        skip("=> ");
        if (!take("]") || !skip(" ") || !skip("0123456789") || !take(" %  ") || !skip("0123456789.e+")) continue;
        take(" ");
        take("k") || take("M") || take("G");
        if (take(" particle-steps/s  left ") && skip("0123456789?")) return true;
    }
    return false;
}

/// True if `text` is at the beginning of a line in which nothing was rewritten.
bool begins_line(std::string const& all, std::string const& text) {
    auto const at = all.find(text);
    return at != all.npos && (at == 0 || all[at - 1] == '\n');
}

void check_stopped(std::vector<std::string> const& words, path const& folder) {
    on_terminal program(words, folder);
    bool seen = false;
    while (program.read_on()) {
        if (seen || !shows_progress(program.text())) continue;
        seen = true;
        program.stop();
    }
    int const status = program.wait();
    require(seen, "no progress was shown:\n" + program.text());
    require(status == 128 + SIGTERM, "exit status " + std::to_string(status) + ":\n" + program.text());
    auto const said = path(words[0]).filename().string() + ": ";
    require(program.text().find(said) == program.text().npos || begins_line(program.text(), said),
            "its last message does not begin a line:\n" + program.text());
    auto const last = program.text().find_last_of("\r\n");
    require(last + 1 == program.text().size(), "the last line has no end:\n" + program.text());
}

/// The output is not a terminal: lets the program run for some time, which must show no progress.
void check_silent(std::vector<std::string> const& words, path const& folder) {
    process::running program(words, folder);
    while (!process::fs::exists(folder / "out") || process::fs::is_empty(folder / "out")) usleep(1000);
    usleep(400000);
    program.send(SIGTERM);
    int const status = program.wait();
    require(status == 128 + SIGTERM || status == 0, "exit status " + std::to_string(status));
    auto const said = process::read_all(folder.string() + ".said");
    require(said.find('\r') == said.npos && said.find(" left ") == said.npos,
            "it shows progress although its output is not a terminal:\n" + said);
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 4) return 2;
    bool const there_alone = std::string(argv[1]) == "there_alone";
    path const folder = process::fs::absolute(argv[2]);
    std::vector<std::string> words(argv + 3, argv + argc);
    words[0] = process::fs::absolute(words[0]).string();
    try {
        for (auto const& check : {check_stopped, check_silent}) {
            if (check == check_silent && !there_alone) continue;
            process::fs::remove_all(folder);
            process::fs::create_directories(folder);
            check(words, folder);
        }
        process::fs::remove_all(folder);
    } catch (std::exception const& bad) {
        std::printf("%s\n", bad.what());
        return 1;
    }
}
