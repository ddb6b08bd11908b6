// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace cartilage {

/// Calls work(k) once for each k from 0 to count - 1, on `jobs` threads (0: one for each processor).
/// \throws the exception of the first call that fails. No call starts after that; the running calls are awaited first.
template <class Work>
void for_each_in_parallel(std::size_t count, int jobs, Work const& work) {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    std::exception_ptr failure;
    std::mutex guard;
    auto const take = [&] {
        for (std::size_t k = next++; k < count && !failed; k = next++) {
            try {
                work(k);
            } catch (...) {
                std::lock_guard const lock(guard);
                if (!failed.exchange(true)) failure = std::current_exception();
            }
        }
    };
    std::vector<std::thread> threads;
    std::size_t const all = jobs > 0 ? std::size_t(jobs) : std::max(1u, std::thread::hardware_concurrency());
    std::size_t const wanted = std::min(all, count);
    for (std::size_t t = 1; t < wanted; ++t) threads.emplace_back(take);
    take();
    for (auto& t : threads) t.join();
    if (failure) std::rethrow_exception(failure);
}

} // namespace cartilage
