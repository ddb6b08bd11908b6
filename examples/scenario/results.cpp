// SPDX-License-Identifier: BSD-3-Clause
#include "results.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include <lacuna/observe/vtk_collection.hpp>

namespace lacuna_run {

namespace fs = std::filesystem;

namespace {

constexpr char const* series_names[] = {"particles", "bonds", "pores"};
constexpr char const *checkpoint_name = "checkpoint.bin", *regular_name = "checkpoint-regular.bin",
                     *summary_name = "summary.json";

std::vector<std::string> known_names() {
    return {summary_name,    "probes.csv",    "events.csv",   checkpoint_name,   regular_name,
            "particles.pvd", "bonds.pvd",     "pores.pvd",    "particles-#.vtp", "bonds-#.vtp",
            "pores-#.vtp",   "picture-#.png", "picture-#.svg"};
}

std::vector<std::pair<std::string, lacuna::file_mark>> marks_of(journal const& j) {
    return {{"probes.csv", j.probes}, {"events.csv", j.events}, {"particles.pvd", j.particles}, {"bonds.pvd", j.bonds},
            {"pores.pvd", j.pores}};
}

/// The step in the name of a frame or picture; -1 for other files.
long long step_of(std::string const& name) {
    auto const dash = name.find('-');
    if (dash == std::string::npos || name.rfind("checkpoint", 0) == 0) return -1;
    return std::strtoll(name.c_str() + dash + 1, nullptr, 10);
}

std::string name_in(std::string const& directory, std::string const& name) {
    return (fs::path(directory) / name).string();
}

void copy_whole(std::string const& from, std::string const& to) {
    lacuna::growing_file::copy_beginning(from, {fs::file_size(from), 0}, to);
}

/// Describes the first file of the journal that is missing in a directory or has other content; empty if all are there.
std::string missing_in(std::string const& directory, journal const& log) {
    for (auto const& [name, mark] : marks_of(log)) {
        std::string const path = name_in(directory, name);
        if (!lacuna::growing_file::begins_with(path, mark))
            return path + " does not begin with the " + std::to_string(mark.bytes) + " bytes that the run wrote";
        if (name.find(".pvd") == std::string::npos || mark.bytes == 0) continue;
        std::ifstream file(path, std::ios::binary);
        std::string text(std::size_t(mark.bytes), ' ');
        file.read(text.data(), std::streamsize(text.size()));
        std::string const before = "file=\"";
        for (auto at = text.find(before); at != text.npos; at = text.find(before, at + 1)) {
            auto const from = at + before.size();
            std::string const frame = name_in(directory, text.substr(from, text.find('"', from) - from));
            if (!fs::exists(frame)) return frame + " is missing; " + name + " lists it";
        }
    }
    return {};
}

} // namespace

resumption find_earlier_part(scenario const& s, std::string const& checkpoint, journal const& log, long long step) {
    std::string const beside = fs::path(checkpoint).parent_path().string();
    std::string missing;
    for (std::string const& directory : {s.output.directory, beside.empty() ? "." : beside}) {
        std::string const why = missing_in(directory, log);
        if (why.empty()) return {checkpoint, step, log, directory};
        if (why != missing) missing += (missing.empty() ? "" : ", and ") + why;
    }
    throw refusal("--restart = \"" + checkpoint +
                  "\": must be in the directory of its run, or output.directory must be that directory: " + missing);
}

results::results(scenario const& s, bool force, bool quiet, resumption const& start)
    : scenario_(s), start_(start),
      directory_(s.output.directory, "output.directory", known_names(),
                 !start.checkpoint.empty() && start.directory == s.output.directory ? lacuna::earlier_results::keep
                 : force                                                    ? lacuna::earlier_results::replace
                                                                            : lacuna::earlier_results::refuse),
      probes_(file("probes.csv"), heading_of(s)), events_(file("events.csv"), event_heading(s)),
      particles_(lacuna::vtk_collection(file("particles.pvd"))), bonds_(lacuna::vtk_collection(file("bonds.pvd"))),
      pores_(lacuna::vtk_collection(file("pores.pvd"))), progress_(!quiet) {}

void results::begin() {
    directory_.keep();
    if (start_.checkpoint.empty()) {
        probes_.begin();
        events_.begin();
        return;
    }
    directory_.remove(summary_name);
    if (start_.directory == scenario_.output.directory)
        remove_later_frames();
    else
        copy_earlier_files();
    std::error_code other;
    if (!fs::equivalent(start_.checkpoint, file(checkpoint_name), other)) {
        copy_whole(start_.checkpoint, file(checkpoint_name));
        directory_.remove(regular_name);
    }
    // With other probes than before, probes.csv starts at the checkpoint.
    if (start_.log.probes.bytes == 0)
        probes_.begin();
    else
        probes_.resume(start_.log.probes);
    events_.resume(start_.log.events);
    particles_.resume(start_.log.particles);
    bonds_.resume(start_.log.bonds);
    pores_.resume(start_.log.pores);
    auto const every = scenario_.output.checkpoint_every;
    checkpoint_is_of_stop_ = every == 0 || start_.step % every != 0;
    if (!checkpoint_is_of_stop_) directory_.remove(regular_name);
}

/// Removes frames and pictures of steps after the checkpoint.
void results::remove_later_frames() const {
    for (auto const& name : directory_.results())
        if (step_of(name) > start_.step) directory_.remove(name);
}

/// Copies the files of the earlier part of the run from another directory, up to the checkpoint.
void results::copy_earlier_files() const {
    for (auto const& [name, mark] : marks_of(start_.log))
        if (mark.bytes > 0) lacuna::growing_file::copy_beginning(name_in(start_.directory, name), mark, file(name));
    std::vector<std::string> names;
    for (auto const& entry : fs::directory_iterator(start_.directory))
        names.push_back(entry.path().filename().string());
    for (auto const& name : names) {
        auto const step = step_of(name);
        if (directory_.is_result(name) && step >= 0 && step <= start_.step)
            copy_whole(name_in(start_.directory, name), file(name));
    }
}

lacuna::growing_file& results::series(std::string const& name) {
    return name == series_names[0] ? particles_ : name == series_names[1] ? bonds_ : pores_;
}

void results::add_frame(std::string const& name, double time, std::string const& frame) {
    auto& grows = series(name);
    if (!grows.has_begun()) grows.begin();
    grows.add(lacuna::vtk_collection_entry(time, frame));
    grows.flush();
}

void results::mark(journal& log) {
    for (auto* growing : {&probes_, &events_, &particles_, &bonds_, &pores_}) growing->sync();
    log.probes = probes_.mark();
    log.events = events_.mark();
    log.particles = particles_.mark();
    log.bonds = bonds_.mark();
    log.pores = pores_.mark();
}

// A resumed run must leave the same files as a run that was never stopped. So the checkpoint of a stop exists only
// until the next regular checkpoint or the end. Until then the last regular checkpoint has another name.
void results::set_regular_checkpoint_aside() {
    if (!std::exchange(checkpoint_is_of_stop_, true) && fs::exists(file(checkpoint_name)))
        fs::copy_file(file(checkpoint_name), file(regular_name), fs::copy_options::overwrite_existing);
}

void results::regular_checkpoint_written() {
    if (std::exchange(checkpoint_is_of_stop_, false)) directory_.remove(regular_name);
}

void results::finish(std::string const& summary, bool ended) {
    for (auto* growing : {&probes_, &events_, &particles_, &bonds_, &pores_}) growing->flush();
    if (ended && checkpoint_is_of_stop_) {
        if (fs::exists(file(regular_name)))
            fs::rename(file(regular_name), file(checkpoint_name));
        else
            directory_.remove(checkpoint_name);
    }
    lacuna::whole_file whole(file(summary_name));
    whole.write(summary);
    whole.commit();
}

} // namespace lacuna_run
