// SPDX-License-Identifier: BSD-3-Clause

#include "catch.hpp"
#include "reference.hpp"

TEST_CASE("reference values are found by id, key and position", "[reference]") {
    REQUIRE(reference("1a.t_c") == 0.0622557996097);
    REQUIRE(reference("1b.zeta=0.1", "c") == 3963.32729761);
    REQUIRE(reference("8d.mixed_path", "psi=0", "kn=ks,sn=ss", 0) == 1.0);
    REQUIRE(reference_text("8d.mixed_path", "psi=0", "kn=ks,sn=ss", 1) == "tension");
    REQUIRE(reference_list("2a.modes_fixed_fixed_N10").front() == 0.284629676547);
    REQUIRE(reference_table("9c.positions").at(1) == std::vector<double>{3.25, 0.0});
}

TEST_CASE("a missing reference is an error", "[reference]") {
    REQUIRE_THROWS_WITH(reference("no such case"), contains_text("no such case"));
    REQUIRE_THROWS_WITH(reference("1b.zeta=0.1", "d"), contains_text("no key 'd'"));
    REQUIRE_THROWS_WITH(reference("9c.positions", 7), contains_text("no position 7"));
    REQUIRE_THROWS_WITH(reference("1b.zeta=0.1"), contains_text("not a number"));
}
