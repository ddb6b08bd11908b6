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

/// Lets `jobs` threads (0: as many as there are processors) call work(k) for k from 0 to count - 1, each once.
/// \throws what the first failing call throws, once the calls under way have ended; no other is begun then
template <class Work>
void share_out(std::size_t count, int jobs, Work const& work) {
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
