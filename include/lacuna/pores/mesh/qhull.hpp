// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <lacuna/core/standard.hpp>

#if !defined(qhDEFlibqhull)
#define LACUNA_TAKES_QHULL_BACK
#endif
extern "C" {
#include <libqhull_r/libqhull_r.h>

#include <libqhull_r/geom_r.h>
}

/// \file
/// The only header that includes Qhull. A program that includes it must link qhull_r.

namespace lacuna::detail {

static_assert(std::is_same_v<coordT, double>);

/// Collects Qhull's messages, which would go to stderr otherwise.
class message_file {
public:
    message_file() {
#if defined(__unix__) || defined(__APPLE__)
        file_ = open_memstream(&text_, &size_);
#else
        file_ = std::tmpfile();
#endif
        if (!file_) throw std::runtime_error("triangulation: no memory for the messages of Qhull");
    }
    message_file(message_file const&) = delete;
    message_file& operator=(message_file const&) = delete;
    ~message_file() {
        std::fclose(file_);
        std::free(text_);
    }
    std::FILE* file() const noexcept { return file_; }
    std::string first_line() const {
        std::fflush(file_);
        std::string const all = text_ ? std::string(text_, size_) : std::string();
        auto const first = all.find_first_not_of("\n ");
        return first == std::string::npos ? "" : all.substr(first, all.find('\n', first) - first);
    }

private:
    std::FILE* file_ = nullptr;
    char* text_ = nullptr;
    std::size_t size_ = 0;
};

/// Owns the memory of one run of Qhull.
struct qhull_memory {
    qhT state;
    explicit qhull_memory(std::FILE* errors) { qh_zero(&state, errors); }
    qhull_memory(qhull_memory const&) = delete;
    qhull_memory& operator=(qhull_memory const&) = delete;
    ~qhull_memory() {
        int current = 0, total = 0;
        qh_freeqhull(&state, 0);
        qh_memfreeshort(&state, &current, &total);
    }
};

/// A convex hull, computed by Qhull.
/// \param points rows of `dimension` coordinates; must outlive the hull
/// \throws std::runtime_error when Qhull fails.
class convex_hull {
public:
    convex_hull(int dimension, std::vector<double>& points) : memory_(messages_.file()) {
        char command[] = "qhull Qt";
        int const count = int(points.size()) / dimension;
        if (qh_new_qhull(get(), dimension, count, points.data(), 0, command, nullptr, messages_.file()) != 0)
            throw std::runtime_error("triangulation: " + messages_.first_line());
    }
    qhT* get() noexcept { return &memory_.state; }
    /// Volume of the hull (in the plane its area), in units of the points.
    double size() noexcept {
        qh_getarea(get(), get()->facet_list);
        return get()->totvol;
    }

private:
    message_file messages_;
    qhull_memory memory_;
};

} // namespace lacuna::detail

#if defined(LACUNA_TAKES_QHULL_BACK)
#include <lacuna/pores/mesh/qhull_macros.hpp>
#undef LACUNA_TAKES_QHULL_BACK
#endif
