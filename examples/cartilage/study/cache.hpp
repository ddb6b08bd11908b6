// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "cartilage/common/options.hpp"
#include "cartilage/study/study_json.hpp"

namespace cartilage {

/// Hash of all sources, the compiler and its flags: results of other code are other results.
std::string_view code_version();

/// All that decides on a run but its load, as text: the model, the packing, the code.
std::string key_of(options const& o);

/// Results kept in a directory by what they are results of: small files that appear whole or not at all. Several
/// threads and programs may use the same directory.
class result_cache {
public:
    /// \param directory created where needed; empty: nothing is kept and nothing found
    /// \throws usage_error when it cannot be written
    explicit result_cache(std::string const& directory);

    /// What was kept under this key; none as well for a file that is damaged.
    std::optional<json> find(std::string const& name, std::string const& key) const;
    /// \param name for the eye, part of the file's name
    /// \throws std::runtime_error when the file cannot be written
    void keep(std::string const& name, std::string const& key, json const& result) const;

private:
    std::string file(std::string const& name, std::string const& key) const;
    std::string directory_;
};

} // namespace cartilage
