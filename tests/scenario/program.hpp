// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>

#include <sys/wait.h>
#include <unistd.h>

/// \file
/// Runs the program lacuna-run in an empty folder and reads its output files.

namespace program {

namespace fs = std::filesystem;

inline std::string read_file(fs::path const& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path.string());
    return {std::istreambuf_iterator<char>(file), {}};
}

struct result {
    int status;
    std::string out, err;
};

/// A folder for one test, empty at first, removed at its end. Tests run side by side: it lies in a folder of the
/// process.
class folder {
public:
    explicit folder(std::string const& name)
        : own_(fs::path(LACUNA_RUN_SCRATCH) / (name + "." + std::to_string(getpid()))), path_(own_ / name) {
        clear();
    }
    folder(folder const&) = delete;
    folder& operator=(folder const&) = delete;
    ~folder() {
        std::error_code ignored;
        fs::remove_all(own_, ignored);
    }
    void clear() const {
        fs::remove_all(path_);
        fs::create_directories(path_);
    }
    fs::path operator/(std::string const& name) const { return path_ / name; }
    void write(std::string const& name, std::string const& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
    }
    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (auto const& entry : fs::recursive_directory_iterator(path_))
            if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), path_).string());
        std::sort(names.begin(), names.end());
        return names;
    }
    /// Runs the program in the folder.
    result run(std::string const& arguments) const {
        std::string const command = "cd '" + path_.string() + "' && '" LACUNA_RUN_PROGRAM "' " + arguments + " >'" +
                                    (path_ / ".out").string() + "' 2>'" + (path_ / ".err").string() + "'";
        int const status = std::system(command.c_str());
        result r{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(path_ / ".out"), read_file(path_ / ".err")};
        fs::remove(path_ / ".out");
        fs::remove(path_ / ".err");
        return r;
    }
    /// Runs one of examples/scenario/cases.
    result run_case(std::string const& name) const { return run("--quiet '" LACUNA_RUN_CASES "/" + name + ".toml'"); }

private:
    fs::path own_, path_;
};

/// A CSV file: heading and rows.
struct table {
    std::vector<std::string> heading;
    std::vector<std::vector<std::string>> rows;

    explicit table(fs::path const& path) {
        std::istringstream text(read_file(path));
        auto const cells = [](std::string const& line) {
            std::vector<std::string> found(1);
            for (char const c : line)
                if (c == ',')
                    found.emplace_back();
                else
                    found.back() += c;
            return found;
        };
        std::string line;
        std::getline(text, line);
        heading = cells(line);
        while (std::getline(text, line)) rows.push_back(cells(line));
    }
    /// The numbers of a column without its empty cells.
    std::vector<double> column(std::string const& name) const {
        std::vector<double> numbers;
        for (std::size_t c = 0; c < heading.size(); ++c)
            if (heading[c] == name) {
                for (auto const& row : rows)
                    if (!row.at(c).empty()) numbers.push_back(std::stod(row[c]));
                return numbers;
            }
        throw std::out_of_range("no column " + name);
    }
    double last(std::string const& name) const { return column(name).back(); }
};

} // namespace program
