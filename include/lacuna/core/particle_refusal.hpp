// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lacuna/core/error.hpp>

namespace lacuna {

/// A refusal that names particles by their indices in the given arrays. A caller that knows them by other numbers, such
/// as a simulation that has sorted them, rethrows it with those numbers: see named().
class particle_refusal : public std::invalid_argument {
public:
    /// "field = value: must be rule", the message of refuse().
    /// \param particles indices that replace each `#` of the text, in this order
    particle_refusal(std::string_view field, std::string_view value, std::string_view rule,
                     std::vector<std::int32_t> particles)
        : particle_refusal(std::string(field) + " = " + std::string(value) + ": must be " + std::string(rule),
                           std::move(particles)) {}
    particle_refusal(std::string_view field, double value, std::string_view rule, std::vector<std::int32_t> particles)
        : particle_refusal(field, to_text(value), rule, std::move(particles)) {}

    /// The same refusal with other numbers.
    /// \param name callable: index of a particle -> the caller's number of that particle
    template <class Name>
    particle_refusal named(Name const& name) const {
        std::vector<std::int32_t> numbers;
        for (auto const i : particles_) numbers.push_back(std::int32_t(name(std::size_t(i))));
        return {text_, std::move(numbers)};
    }

private:
    particle_refusal(std::string text, std::vector<std::int32_t> particles)
        : std::invalid_argument(filled(text, particles)), text_(std::move(text)), particles_(std::move(particles)) {}

    static std::string filled(std::string_view text, std::vector<std::int32_t> const& particles) {
        std::string all;
        std::size_t next = 0;
        for (char const c : text) {
            if (c == '#' && next < particles.size())
                all += std::to_string(particles[next++]);
            else
                all += c;
        }
        return all;
    }

    std::string text_;
    std::vector<std::int32_t> particles_;
};

} // namespace lacuna
