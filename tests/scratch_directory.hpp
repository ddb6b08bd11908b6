// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

/// A fresh directory that goes away with the test.
struct scratch_directory {
    std::filesystem::path path;
    scratch_directory() {
        std::string pattern = (std::filesystem::temp_directory_path() / "lacuna_test_XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no scratch directory");
        path = pattern;
    }
    ~scratch_directory() { std::filesystem::remove_all(path); }
    std::string file(std::string const& name) const { return (path / name).string(); }
    std::size_t entries() const { return std::size_t(std::distance(std::filesystem::directory_iterator(path), {})); }
};

inline std::string bytes_of(std::string const& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
