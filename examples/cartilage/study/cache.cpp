// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/study/cache.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <lacuna/core/error.hpp>
#include <lacuna/core/whole_file.hpp>
#include <lacuna/observe/checkpoint_file.hpp>
#include <lacuna/observe/directory_lock.hpp>

#include "code_version.hpp"

namespace cartilage {

namespace fs = std::filesystem;

namespace {

std::string hexadecimal(std::string_view bytes) {
    char digits[20];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(lacuna::checksum_of(bytes)));
    return digits;
}

} // namespace

std::string_view code_version() { return CARTILAGE_CODE_VERSION; }

std::string key_of(options const& o) {
    std::string key = "code " + std::string(code_version()) + "\nzone " + std::string(lacuna::to_string(o.zone));
    key += "\nseed " + std::to_string(o.seed);
    key += "\nlength_um " + lacuna::to_text(o.length_um) + "\nheight_um " + lacuna::to_text(o.height_um);
    key += "\nstep_share " + lacuna::to_text(o.step_share);
    return key + (o.dry ? "\ndry\n" : "\nwet\n") + text_of(o.choices, true);
}

result_cache::result_cache(std::string const& directory) : directory_(directory) {
    if (directory_.empty()) return;
    std::error_code error;
    fs::create_directories(directory_, error);
    if (error) throw usage_error("cache directory " + directory_ + ": " + error.message());
    lacuna::remove_unfinished_files(directory_, [](std::string_view name) {
        return name == ".cartilage-probe" || (name.size() > 5 && name.substr(name.size() - 5) == ".json");
    });
    try {
        lacuna::whole_file probe((fs::path(directory_) / ".cartilage-probe").string());
    } catch (std::runtime_error const&) {
        throw usage_error("cache directory " + directory_ + ": cannot be written");
    }
}

std::string result_cache::file(std::string const& name, std::string const& key) const {
    return (fs::path(directory_) / (name + "-" + hexadecimal(key) + ".json")).string();
}

std::optional<json> result_cache::find(std::string const& name, std::string const& key) const {
    if (directory_.empty()) return std::nullopt;
    std::ifstream in(file(name, key), std::ios::binary);
    if (!in) return std::nullopt;
    std::string const text{std::istreambuf_iterator<char>(in), {}};
    json entry = json::parse(text, nullptr, false);
    if (!entry.is_object() || !entry.contains("key") || !entry.contains("checksum") || !entry.contains("result"))
        return std::nullopt;
    if (entry["key"] != key || entry["checksum"] != hexadecimal(entry["result"].dump())) return std::nullopt;
    return std::move(entry["result"]);
}

void result_cache::store(std::string const& name, std::string const& key, json const& result) const {
    if (directory_.empty()) return;
    std::string const text = result.dump();
    lacuna::whole_file out(file(name, key));
    out.write("{\"key\": " + json(key).dump() + ",\n\"checksum\": \"" + hexadecimal(text) + "\",\n\"result\": " + text +
              "}\n");
    out.commit();
}

} // namespace cartilage
