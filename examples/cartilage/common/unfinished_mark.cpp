// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/common/unfinished_mark.hpp"

#include <filesystem>
#include <system_error>

#include <lacuna/observe/stop_signal.hpp>

#include "cartilage/common/json_writer.hpp"
#include "cartilage/common/write_whole.hpp"

namespace cartilage {

unfinished_mark::unfinished_mark(lacuna::run_directory& out, std::string const& command)
    : out_(out), command_(command) {
    // Complete results of an earlier command stay until new ones replace them, so they must not get a mark.
    if (out.results().empty() || exists()) write("not yet");
}

lacuna::earlier_results unfinished_mark::earlier(std::string const& directory, std::string const& command, bool force) {
    std::error_code error;
    return force || std::filesystem::exists(std::filesystem::path(directory) / name_of(command), error)
               ? lacuna::earlier_results::replace
               : lacuna::earlier_results::refuse;
}

bool unfinished_mark::exists() const {
    std::error_code error;
    return std::filesystem::exists(out_.file(name_of(command_)), error);
}

void unfinished_mark::begin_results() const {
    write("not yet");
    out_.keep();
}

void unfinished_mark::record_signal() const {
    if (exists()) write("stopped by " + lacuna::signal_name(lacuna::stop_signal()));
}

void unfinished_mark::write(std::string const& ended) const {
    out_.stay();
    json_writer json;
    json.open('{').value("command", command_).value("ended", ended);
    json.value("message", "the same command continues from the finished runs in the cache").close('}');
    write_whole(out_.file(name_of(command_)), json.text());
}

} // namespace cartilage
