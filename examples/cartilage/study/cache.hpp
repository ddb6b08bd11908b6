// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "cartilage/common/options.hpp"
#include "cartilage/study/study_json.hpp"

namespace cartilage {

/// Hash of the sources, the compiler and its flags. Results of other code are not reused.
std::string_view code_version();

/// Everything except the load that determines a run, as text: model, packing and code.
std::string key_of(options const& o);

/// Stores results in a directory by their key, in small files that appear complete or not at all. Several threads and
/// programs may use the same directory.
class result_cache {
public:
    /// \param directory created if missing; empty: nothing is stored and nothing is found
    /// \throws usage_error if it cannot be written
    explicit result_cache(std::string const& directory);

    /// The result stored under this key; none if there is none or its file is damaged.
    std::optional<json> find(std::string const& name, std::string const& key) const;
    /// Stores a result. \param name part of the file's name, for readers of the directory
    /// \throws std::runtime_error if the file cannot be written
    void store(std::string const& name, std::string const& key, json const& result) const;

private:
    std::string file(std::string const& name, std::string const& key) const;
    std::string directory_;
};

} // namespace cartilage
