// SPDX-License-Identifier: BSD-3-Clause
#include "catch.hpp"

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "cartilage/report/html.hpp"
#include "cartilage/report/study_report.hpp"
#include "synthetic_study.hpp"

namespace {
struct scratch {
    std::string path = (std::filesystem::temp_directory_path() / "lacuna_report_XXXXXX").string();
    scratch() {
        if (mkdtemp(path.data()) == nullptr) throw std::runtime_error("no scratch directory");
    }
    ~scratch() { std::filesystem::remove_all(path); }
    std::string file(char const* name) const { return path + "/" + name; }
};

std::size_t count(std::string const& text, std::string const& word) {
    std::size_t n = 0;
    for (std::size_t pos = text.find(word); pos != std::string::npos; pos = text.find(word, pos + 1)) ++n;
    return n;
}
} // namespace

TEST_CASE("base64 as in RFC 4648, section 10") {
    CHECK(cartilage::base64("") == "");
    CHECK(cartilage::base64("f") == "Zg==");
    CHECK(cartilage::base64("fo") == "Zm8=");
    CHECK(cartilage::base64("foo") == "Zm9v");
    CHECK(cartilage::base64("foobar") == "Zm9vYmFy");
    CHECK(cartilage::base64("\xff\xfe\xfd") == "//79");
}

TEST_CASE("text of a page is escaped") {
    CHECK(cartilage::html_text("a < b & \"c\" > d") == "a &lt; b &amp; &quot;c&quot; &gt; d");
    CHECK_THAT(cartilage::html_table("x", {"<h>"}, {{"<r>", "<c>"}}),
               contains_text("<th scope=\"row\">&lt;r&gt;</th>"));
    CHECK_THROWS_WITH(cartilage::file_bytes("/nowhere/x.png"), contains_text("/nowhere/x.png"));
}

TEST_CASE("a report has its table, its figures and its invalid runs, and is the same twice") {
    scratch a, b;
    auto study = synthetic_study(3);
    cartilage::write_report(a.path, study);
    cartilage::write_report(b.path, study);
    std::string const page = cartilage::file_bytes(a.file("report.html"));
    CHECK(page == cartilage::file_bytes(b.file("report.html")));
    CHECK(count(page, "<table") == 4);
    // 3 of loads, 4 zones with damage, first cracks, positions and layers, 3 snapshots with fronts.
    CHECK(count(page, "<img ") == 25);
    CHECK(count(page, "<figcaption>") == 25);
    CHECK(count(page, "<script") == 0);
    CHECK(count(page, "src=\"data:") == 25);
    CHECK(count(page, "http://") + count(page, "https://") == 0);
    CHECK_THAT(page, contains_text("4 of 108 runs do not count"));
    CHECK_THAT(page, contains_text("the energy ledger is open by ... % &lt;synthetic&gt;"));
    CHECK_THAT(page, contains_text("load area = disc"));
    for (char const* name : {"table3.csv", "damage-deep.png", "damage-deep.svg", "fronts-12.png", "figure-10.svg"})
        CHECK(std::filesystem::file_size(a.file(name)) > 100);

    study.packings.resize(3);
    study.snapshots.clear();
    cartilage::write_report(b.path, study);
    CHECK(count(cartilage::file_bytes(b.file("report.html")), "<img ") == 7);
    CHECK_FALSE(std::filesystem::exists(b.file("figure-10.png")));
    CHECK(std::filesystem::exists(b.file("damage-surface.png")));
}

TEST_CASE("a study without packings or with bad numbers is refused by name") {
    scratch dir;
    cartilage::study_result study;
    CHECK_THROWS_WITH(cartilage::write_report(dir.path, study), contains_text("study.packings"));
    study = synthetic_study(1);
    study.resolution = 0;
    CHECK_THROWS_WITH(cartilage::write_report(dir.path, study), contains_text("study.resolution"));
    study = synthetic_study(1);
    study.packings[0].found.capacity_MPa = 2000;
    CHECK_THROWS_WITH(cartilage::write_report(dir.path, study), contains_text("study.packings.found"));
    CHECK(std::filesystem::is_empty(dir.path));
}
