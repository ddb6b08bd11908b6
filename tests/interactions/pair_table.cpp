// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <lacuna/interactions/storage/contact_list.hpp>
#include <lacuna/interactions/storage/force_offsets.hpp>
#include <lacuna/interactions/storage/pair_table.hpp>
#include <lacuna/laws/brittle_spring_bond.hpp>
#include <lacuna/laws/frictional_spring.hpp>

#include "catch.hpp"

namespace {

using contacts_2d = lacuna::pair_table<lacuna::frictional_spring, double, 2>;
using bonds_2d = lacuna::pair_table<lacuna::brittle_spring_bond, double, 2>;
using store_2d = lacuna::particle_store<double, 2>;
using pair = std::pair<std::int32_t, std::int32_t>;
constexpr std::size_t width = contacts_2d::width;

store_2d discs(int count) {
    lacuna::packing<double, 2> p;
    for (int k = 0; k < count; ++k) p.add({double(k), 0}, 0.5);
    std::vector<std::int32_t> order(p.size());
    std::iota(order.begin(), order.end(), 0);
    return {p, order, std::vector{1.0}, lacuna::mass_model::disc, 1};
}

/// A history that identifies its contact by a number.
contacts_2d::history mark(double value) { return {value, {value + 0.5}}; }

contacts_2d::entry contact(std::int32_t i, std::int32_t j, double value, std::int32_t row = 0) {
    return {i, j, row, -1, mark(value)};
}

template <class Pairs>
std::vector<lacuna::neighbor_pair> candidates(Pairs const& pairs) {
    std::vector<lacuna::neighbor_pair> list;
    for (auto const& [i, j] : pairs) list.push_back({i, j});
    return list;
}

/// The pairs of a table, slot by slot. REQUIREs that a chunk's pairs fill its first packs, and that all other slots are
/// padding.
std::vector<contacts_2d::entry> content(contacts_2d const& table, std::size_t particles) {
    std::vector<contacts_2d::entry> list;
    std::size_t in_use = 0;
    for (int c = 0; c < table.chunks(); ++c) {
        REQUIRE(table.end_pack(c) <= table.first_pack(c + 1));
        std::size_t pairs = 0;
        for (std::size_t s = table.first_pack(c) * width; s < table.end_pack(c) * width; ++s) {
            if (table.is_padding(s, particles)) continue;
            REQUIRE(s == table.first_pack(c) * width + pairs);
            REQUIRE(table.i(s) / contacts_2d::chunk_particles == c);
            ++pairs;
            list.push_back(table.get(s));
        }
        REQUIRE(table.end_pack(c) - table.first_pack(c) == (pairs + width - 1) / width);
        in_use += pairs;
    }
    std::size_t all = 0;
    for (std::size_t s = 0; s < table.slots(); ++s) all += table.is_padding(s, particles) ? 0 : 1;
    REQUIRE(all == in_use);
    REQUIRE(table.size() == in_use);
    return list;
}

bool same(contacts_2d::entry const& a, contacts_2d::entry const& b) {
    return a.i == b.i && a.j == b.j && a.parameter == b.parameter && a.label == b.label &&
           a.state.touching_distance == b.state.touching_distance && a.state.shear_force[0] == b.state.shear_force[0];
}
void require_same(std::vector<contacts_2d::entry> const& a, std::vector<contacts_2d::entry> const& b) {
    REQUIRE(a.size() == b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
        CAPTURE(k, a[k].i, a[k].j, b[k].i, b[k].j);
        REQUIRE(same(a[k], b[k]));
    }
}

} // namespace

TEST_CASE("pair_table: pairs are added, stay and are removed within their chunk", "[interactions][pair_table]") {
    auto const store = discs(300); // chunks 0 to 127, 128 to 255, 256 to 299
    contacts_2d table;
    double next = 100;
    auto const make = [&](lacuna::neighbor_pair const& p) { return contact(p.i, p.j, next++); };
    // A merge makes the new pairs of a chunk from the last to the first, so that their marks count in this order.
    merge_contacts(candidates(std::vector<pair>{{0, 1}, {0, 3}, {5, 200}, {130, 131}}), bonds_2d(), {}, table, store, 1,
                   make);
    require_same(content(table, 300),
                 {contact(0, 1, 102), contact(0, 3, 101), contact(5, 200, 100), contact(130, 131, 103)});
    REQUIRE(table.chunks() == 3);
    std::vector<std::size_t> const begins{table.first_pack(0), table.first_pack(1), table.first_pack(2), table.packs()};

    // First chunk: the first pair is removed, others are added before, between and behind. The second chunk does not
    // change, the third gets its first pair.
    merge_contacts(candidates(std::vector<pair>{{0, 2}, {0, 3}, {4, 5}, {5, 200}, {5, 201}, {130, 131}, {298, 299}}),
                   bonds_2d(), {}, table, store, 1, make);
    require_same(content(table, 300), {contact(0, 2, 106), contact(0, 3, 101), contact(4, 5, 105), contact(5, 200, 100),
                                       contact(5, 201, 104), contact(130, 131, 103), contact(298, 299, 107)});
    REQUIRE(table.find(4, 5) == 2);
    REQUIRE(table.find(0, 1) == -1);
    REQUIRE(table.find(298, 299) == std::int32_t(table.first_pack(2) * width));

    // A bond removes its pair from the contacts. After the bond has broken, the contact has the history that is passed.
    bonds_2d bonds;
    bonds.assign(std::vector<bonds_2d::entry>{{4, 5, 0, 0, {}}, {5, 200, 0, 1, {}}}, store);
    auto const all = candidates(std::vector<pair>{{0, 3}, {4, 5}, {5, 200}, {5, 201}, {130, 131}});
    merge_contacts(all, bonds, {}, table, store, 1, make);
    require_same(content(table, 300), {contact(0, 3, 101), contact(5, 201, 104), contact(130, 131, 103)});
    bonds.filter(store, [&](std::size_t s) { return bonds.label(s) == 0; });
    REQUIRE(bonds.size() == 1);
    REQUIRE(bonds.label(0) == 0);
    merge_contacts(all, bonds, {contact(5, 200, 7, 3)}, table, store, 1, make);
    require_same(content(table, 300),
                 {contact(0, 3, 101), contact(5, 200, 7, 3), contact(5, 201, 104), contact(130, 131, 103)});
    REQUIRE(table.uniform_parameter(0) == -1);
    REQUIRE(table.uniform_parameter(table.first_pack(1)) == 0);

    merge_contacts({}, bonds_2d(), {}, table, store, 1, make);
    REQUIRE(content(table, 300).empty());
    // No chunk had to grow.
    REQUIRE(begins ==
            std::vector<std::size_t>{table.first_pack(0), table.first_pack(1), table.first_pack(2), table.packs()});
}

TEST_CASE("pair_table: a chunk that outgrows its packs gets more, and no history is lost",
          "[interactions][pair_table]") {
    auto const store = discs(300);
    contacts_2d table;
    auto const make = [](lacuna::neighbor_pair const& p) { return contact(p.i, p.j, 1000 * p.i + p.j); };
    std::vector<pair> wanted{{3, 4}, {130, 131}, {256, 257}};
    merge_contacts(candidates(wanted), bonds_2d(), {}, table, store, 1, make);
    // Each chunk has one pack and a spare one.
    for (int c = 0; c <= 3; ++c) REQUIRE(table.first_pack(c) == 2 * std::size_t(c));

    // Pairs that a merge makes instead of copying them differ by 0.25.
    auto const make_new = [](lacuna::neighbor_pair const& p) { return contact(p.i, p.j, 1000 * p.i + p.j + 0.25); };
    wanted = {{3, 4}};
    for (int j = 131; wanted.size() < 1 + 2 * width; ++j) wanted.push_back({130, j});
    wanted.push_back({256, 257});
    merge_contacts(candidates(wanted), bonds_2d(), {}, table, store, 1, make_new);
    REQUIRE(table.first_pack(2) == 4); // still two packs
    wanted.insert(wanted.end() - 1, {131, 255});
    wanted.insert(wanted.end(), {258, 270});
    merge_contacts(candidates(wanted), bonds_2d(), {}, table, store, 1, make_new);
    REQUIRE(table.end_pack(1) - table.first_pack(1) == 3);
    REQUIRE(table.first_pack(2) - table.first_pack(1) == 4);
    std::vector<contacts_2d::entry> expected;
    for (auto const& [i, j] : wanted) {
        bool const old = pair(i, j) == pair(3, 4) || pair(i, j) == pair(130, 131) || pair(i, j) == pair(256, 257);
        expected.push_back(contact(i, j, 1000 * i + j + (old ? 0 : 0.25)));
    }
    require_same(content(table, 300), expected);
}

TEST_CASE("pair_table: after many merges it agrees with a map, for any number of threads",
          "[interactions][pair_table]") {
    int const count = 128 * 5 + 17;
    auto const store = discs(count);
    std::mt19937 gen(42);
    auto const below = [&](int n) { return int(gen() % std::uint32_t(n)); };
    std::set<pair> near;
    std::map<pair, double> known; // the reference: the history of every contact
    std::set<pair> bonded;
    for (int k = 0; k < 300; ++k) {
        int const i = below(count - 30);
        bonded.insert({i, i + 1 + below(29)});
    }
    std::vector<contacts_2d> tables(3);
    int layouts = 0, in_place = 0;
    for (int round = 0; round < 60; ++round) {
        // At first most changes add pairs, later most remove them. In each round one chunk does not change.
        for (int k = 0; k < 200; ++k) {
            int const i = below(count - 30);
            if (i / 128 == round % 5) continue;
            pair const p{i, i + 1 + below(29)};
            if (below(60) > round)
                near.insert(p);
            else
                near.erase(p);
        }
        std::vector<contacts_2d::entry> added;
        if (round % 7 == 3) {
            // A tenth of the bonds break.
            for (auto b = bonded.begin(); b != bonded.end();) {
                if (below(10) > 0) {
                    ++b;
                    continue;
                }
                added.push_back(contact(b->first, b->second, -1000 * b->first - b->second));
                b = bonded.erase(b);
            }
        }
        auto wanted = near;
        wanted.insert(bonded.begin(), bonded.end());
        std::vector<bonds_2d::entry> bond_entries;
        for (auto const& [i, j] : bonded) bond_entries.push_back({i, j, 0, std::int32_t(bond_entries.size()), {}});
        bonds_2d bonds;
        bonds.assign(bond_entries, store);

        std::map<pair, double> now;
        for (auto const& p : wanted) {
            if (bonded.count(p)) continue;
            double value = p.first + p.second / 1024.0 + 1e4 * round;
            for (auto const& a : added)
                if (pair(a.i, a.j) == p) value = a.state.touching_distance;
            if (auto const old = known.find(p); old != known.end()) value = old->second;
            now[p] = value;
        }
        known = now;
        std::vector<contacts_2d::entry> expected;
        auto const row = [](std::int32_t i) { return i % 128 < 64 ? 2 : i % 3; };
        for (auto const& [p, value] : known) expected.push_back(contact(p.first, p.second, value, row(p.first)));
        for (auto& a : added) a.parameter = row(a.i);

        std::size_t const before = tables[0].packs();
        for (std::size_t t = 0; t < tables.size(); ++t) {
            merge_contacts(candidates(wanted), bonds, added, tables[t], store, int(t) + 1,
                           [&](lacuna::neighbor_pair const& p) {
                               return contact(p.i, p.j, p.i + p.j / 1024.0 + 1e4 * round, row(p.i));
                           });
            require_same(content(tables[t], std::size_t(count)), expected);
            REQUIRE(tables[t].packs() == tables[0].packs());
        }
        ++(tables[0].packs() == before ? in_place : layouts);
        for (int c = 0; c < tables[0].chunks(); ++c)
            for (std::size_t p = tables[0].first_pack(c); p < tables[0].end_pack(c); ++p) {
                std::set<std::int32_t> rows;
                for (std::size_t s = p * width; s < (p + 1) * width; ++s) rows.insert(tables[0].parameter()[s]);
                REQUIRE(tables[0].uniform_parameter(p) == (rows.size() == 1 ? *rows.begin() : -1));
            }
        for (auto const& e : expected) {
            auto const slot = tables[0].find(e.i, e.j);
            REQUIRE(slot >= 0);
            REQUIRE(same(tables[0].get(std::size_t(slot)), e));
        }
    }
    REQUIRE(layouts > 2);
    REQUIRE(in_place > 30);
}

TEST_CASE("force_offsets: spare packs change no offset", "[interactions][pair_table]") {
    int const count = 128 * 40;
    auto const store = discs(count);
    std::mt19937 gen(7);
    std::set<pair> pairs;
    while (pairs.size() < 9000) {
        int const i = int(gen() % std::uint32_t(count - 200));
        pairs.insert({i, i + 1 + int(gen() % 199)});
    }
    auto const make = [](lacuna::neighbor_pair const& p) { return contact(p.i, p.j, 0); };
    contacts_2d roomy, tight;
    merge_contacts(candidates(pairs), bonds_2d(), {}, roomy, store, 1, make);
    tight.assign(content(roomy, std::size_t(count)), store);
    REQUIRE(tight.packs() < roomy.packs());
    for (bool const streaming : {false, true})
        for (int const threads : {1, 3}) {
            CAPTURE(streaming, threads);
            lacuna::chunk_spans spans;
            spans.build(roomy.chunks(), threads, std::size_t(count), roomy);
            REQUIRE(spans.count() == threads);
            lacuna::force_offsets a, b;
            a.build(roomy, std::size_t(count), spans, streaming);
            b.build(tight, std::size_t(count), spans, streaming);
            REQUIRE(a.count() == b.count());
            if (streaming) REQUIRE(a.count() < tight.packs() / 2);
            for (int c = 0; c < roomy.chunks(); ++c) {
                REQUIRE(a.of_chunk(roomy, c).first == b.of_chunk(tight, c).first);
                for (std::size_t k = 0; k < tight.end_pack(c) - tight.first_pack(c); ++k)
                    REQUIRE(a(c, roomy.first_pack(c) + k) == b(c, tight.first_pack(c) + k));
            }
        }
}

TEST_CASE("force_offsets: a force stays until it is summed, however far pairs reach", "[interactions][pair_table]") {
    int const count = 128 * 60;
    auto const store = discs(count);
    std::mt19937 gen(11);
    std::set<pair> near;
    while (near.size() < 9000) {
        int const i = int(gen() % std::uint32_t(count - 200));
        near.insert({i, i + 1 + int(gen() % 199)});
    }
    auto const make = [](lacuna::neighbor_pair const& p) { return contact(p.i, p.j, 0); };
    for (bool const far : {false, true})
        for (int const threads : {1, 2, 3}) {
            CAPTURE(far, threads);
            auto pairs = near;
            if (far) pairs.insert({{0, count - 1}, {300, 4000}, {3000, 5000}});
            contacts_2d table;
            merge_contacts(candidates(pairs), bonds_2d(), {}, table, store, 1, make);
            lacuna::chunk_spans spans;
            spans.build(table.chunks(), threads, std::size_t(count), table);
            REQUIRE(spans.count() == threads);
            lacuna::force_offsets offsets;
            offsets.build(table, std::size_t(count), spans, true);
            // A long pair takes up an offset for the chunks that it concerns, not for all.
            REQUIRE(offsets.count() < (far ? 2 * table.packs() / 3 : table.packs() / 2));
            int waiting = 0;
            for (int c = 0; c < table.chunks(); ++c) waiting += spans.waits(c);
            REQUIRE(waiting <= 3 * (threads - 1) + 3 * far);
            std::vector<std::ptrdiff_t> stored(offsets.count(), -1); // the pack whose force is at each offset
            auto const sum_up = [&](int chunk) {
                for (int c = 0; c <= chunk; ++c)
                    for (std::size_t p = table.first_pack(c); p < table.end_pack(c); ++p)
                        for (std::size_t s = p * width; s < (p + 1) * width; ++s)
                            if (!table.is_padding(s, std::size_t(count)) && (c == chunk || table.j(s) / 128 == chunk))
                                REQUIRE(stored[offsets(c, p)] == std::ptrdiff_t(p));
            };
            // Spans may run in any order, here the last one first.
            for (int s = threads; s-- > 0;)
                for (int c = spans.begin(s); c < spans.end(s); ++c) {
                    for (std::size_t p = table.first_pack(c); p < table.end_pack(c); ++p)
                        stored[offsets(c, p)] = std::ptrdiff_t(p);
                    if (!spans.waits(c)) sum_up(c);
                }
            for (int c = 0; c < table.chunks(); ++c)
                if (spans.waits(c)) sum_up(c);
        }
}
