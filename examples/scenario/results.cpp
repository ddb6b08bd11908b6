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
constexpr char const *checkpoint_name = "checkpoint.bin", *regular_name = "checkpoint-regular.bin", *summary_name = "summary.json";

std::vector<std::string> known_names() {
    return {summary_name,      "probes.csv",      "events.csv",  checkpoint_name, regular_name,    "particles.pvd", "bonds.pvd",
            "pores.pvd",       "particles-#.vtp", "bonds-#.vtp", "pores-#.vtp",   "picture-#.png", "picture-#.svg"};
}

std::vector<std::pair<std::string, lacuna::file_mark>> marks_of(journal const& j) {
    return {{"probes.csv", j.probes}, {"events.csv", j.events}, {"particles.pvd", j.particles}, {"bonds.pvd", j.bonds},
            {"pores.pvd", j.pores}};
}

/// Step of a frame or picture by its name, -1 for other files.
long long step_of(std::string const& name) {
    auto const dash = name.find('-');
    if (dash == std::string::npos || name.rfind("checkpoint", 0) == 0) return -1;
    return std::strtoll(name.c_str() + dash + 1, nullptr, 10);
}

std::string name_in(std::string const& directory, std::string const& name) { return (fs::path(directory) / name).string(); }

void copy_whole(std::string const& from, std::string const& to) {
    lacuna::growing_file::copy_beginning(from, {fs::file_size(from), 0}, to);
}

/// What is missing in a directory of all that the journal says, empty for nothing.
std::string missing_in(std::string const& directory, journal const& told) {
    for (auto const& [name, mark] : marks_of(told)) {
        std::string const path = name_in(directory, name);
        if (!lacuna::growing_file::begins_with(path, mark))
            return path + " does not begin with the " + std::to_string(mark.bytes) + " bytes that the run had written";
        if (name.find(".pvd") == std::string::npos || mark.bytes == 0) continue;
        std::ifstream file(path, std::ios::binary);
        std::string text(std::size_t(mark.bytes), ' ');
        file.read(text.data(), std::streamsize(text.size()));
        std::string const before = "file=\"";
        for (auto at = text.find(before); at != text.npos; at = text.find(before, at + 1)) {
            auto const from = at + before.size();
            std::string const frame = name_in(directory, text.substr(from, text.find('"', from) - from));
            if (!fs::exists(frame)) return frame + " is missing, which " + name + " lists";
        }
    }
    return {};
}

} // namespace

resumption find_earlier_part(scenario const& s, std::string const& checkpoint, journal const& told, long long step) {
    std::string const beside = fs::path(checkpoint).parent_path().string();
    std::string missing;
    for (std::string const& directory : {s.out.directory, beside.empty() ? "." : beside}) {
        std::string const why = missing_in(directory, told);
        if (why.empty()) return {checkpoint, step, told, directory};
        if (why != missing) missing += (missing.empty() ? "" : ", and ") + why;
    }
    throw refusal("--restart = \"" + checkpoint + "\": must be in its run's directory, or that be output.directory: " + missing);
}

results::results(scenario const& s, bool force, bool quiet, resumption const& start)
    : scenario_(s), start_(start),
      directory_(s.out.directory, "output.directory", known_names(),
                 !start.checkpoint.empty() && start.from == s.out.directory ? lacuna::earlier_results::keep
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
    if (start_.from == scenario_.out.directory)
        drop_later_frames();
    else
        bring_over();
    std::error_code other;
    if (!fs::equivalent(start_.checkpoint, file(checkpoint_name), other)) {
        copy_whole(start_.checkpoint, file(checkpoint_name));
        directory_.remove(regular_name);
    }
    // With other probes than before their file begins here.
    if (start_.told.probes.bytes == 0)
        probes_.begin();
    else
        probes_.resume(start_.told.probes);
    events_.resume(start_.told.events);
    particles_.resume(start_.told.particles);
    bonds_.resume(start_.told.bonds);
    pores_.resume(start_.told.pores);
    auto const every = scenario_.out.checkpoint_every;
    stopped_between_ = every == 0 || start_.step % every != 0;
    if (!stopped_between_) directory_.remove(regular_name);
}

/// Frames and pictures after the checkpoint.
void results::drop_later_frames() const {
    for (auto const& name : directory_.results())
        if (step_of(name) > start_.step) directory_.remove(name);
}

/// Copies what the earlier part of the run has left in another directory, up to the checkpoint.
void results::bring_over() const {
    for (auto const& [name, mark] : marks_of(start_.told))
        if (mark.bytes > 0) lacuna::growing_file::copy_beginning(name_in(start_.from, name), mark, file(name));
    std::vector<std::string> names;
    for (auto const& entry : fs::directory_iterator(start_.from)) names.push_back(entry.path().filename().string());
    for (auto const& name : names) {
        auto const step = step_of(name);
        if (directory_.is_result(name) && step >= 0 && step <= start_.step) copy_whole(name_in(start_.from, name), file(name));
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

void results::mark(journal& told) {
    for (auto* log : {&probes_, &events_, &particles_, &bonds_, &pores_}) log->sync();
    told.probes = probes_.mark();
    told.events = events_.mark();
    told.particles = particles_.mark();
    told.bonds = bonds_.mark();
    told.pores = pores_.mark();
}

// A resumed run is to leave the files of the run that was never stopped. So the checkpoint of a stop is there until the next
// regular one or the end, and the regular one before it meanwhile has another name.
void results::make_room_for_stop() {
    if (!std::exchange(stopped_between_, true) && fs::exists(file(checkpoint_name)))
        fs::copy_file(file(checkpoint_name), file(regular_name), fs::copy_options::overwrite_existing);
}

void results::checkpoint_is_regular() {
    if (std::exchange(stopped_between_, false)) directory_.remove(regular_name);
}

void results::finish(std::string const& summary, bool ended) {
    for (auto* log : {&probes_, &events_, &particles_, &bonds_, &pores_}) log->flush();
    if (ended && stopped_between_) {
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
