// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <limits>
#include <vector>

#include <lacuna/core/dual.hpp>
#include <lacuna/core/error.hpp>
#include <lacuna/core/fields.hpp>
#include <lacuna/core/pack.hpp>
#include <lacuna/core/records.hpp>
#include <lacuna/core/vec.hpp>

#include "catch.hpp"

using namespace lacuna;

namespace {

template <class T, int W>
void check_pack() {
    using P = pack<T, W>;
    std::vector<T> a, b;
    for (int k = 0; k < W; ++k) {
        a.push_back(T(1.5) * T(k) - T(2));
        b.push_back(T(0.25) * T(k * k) + T(0.5));
    }
    P const x = P::load(a.data()), y = P::load(b.data());
    T total = 0;
    for (int k = 0; k < W; ++k) {
        T const p = a[std::size_t(k)], q = b[std::size_t(k)];
        total += p;
        REQUIRE((x + y)[k] == p + q);
        REQUIRE((x - y)[k] == p - q);
        REQUIRE((x * y)[k] == p * q);
        REQUIRE((x / y)[k] == p / q);
        REQUIRE((-x)[k] == -p);
        REQUIRE(sqrt(y)[k] == std::sqrt(q));
        REQUIRE(abs(x)[k] == std::fabs(p));
        REQUIRE(min(x, y)[k] == std::min(p, q));
        REQUIRE(max(x, y)[k] == std::max(p, q));
        REQUIRE((x < y)[k] == (p < q));
        REQUIRE((x > y)[k] == (p > q));
        REQUIRE((x <= P(p))[k]);
        REQUIRE((x >= P(p))[k]);
        REQUIRE(select(x < y, x, y)[k] == (p < q ? p : q));
        REQUIRE((!(x < y))[k] == !(p < q));
        REQUIRE(((x < y) && (x > P(T(0))))[k] == (p < q && p > 0));
        REQUIRE(((x < y) || (x > P(T(0))))[k] == (p < q || p > 0));
        // any() and all() notice a single lane that differs, whichever it is.
        P alone(T(0));
        alone.v[k] = 1;
        REQUIRE(any(alone > P(T(0))));
        REQUIRE_FALSE(all(alone > P(T(0))));
        REQUIRE_FALSE(all(alone <= P(T(0))));
    }
    REQUIRE_FALSE(any(x < x));
    REQUIRE(all(x <= x));
    REQUIRE(sum(x) == total);
    REQUIRE_FALSE(any(P(std::numeric_limits<T>::quiet_NaN()) < x));
    std::vector<T> out(1 + std::size_t(W));
    x.store(out.data() + 1); // any alignment
    REQUIRE(std::vector<T>(out.begin() + 1, out.end()) == a);
    std::vector<int> index;
    for (int k = 0; k < W; ++k) index.push_back(W - 1 - k);
    for (int k = 0; k < W; ++k) REQUIRE(P::gather(a.data(), index.data())[k] == a[std::size_t(W - 1 - k)]);
}

template <class T, int W>
void check_records() {
    record_column<T> column;
    column.assign(40, record<T>(T(-1)));
    for (std::size_t k = 0; k < 40; ++k)
        for (int l = 0; l < 4; ++l) column.at(k, l) = T(10 * k) + T(l);
    REQUIRE(column.size() == 40);
    REQUIRE(reinterpret_cast<std::uintptr_t>(column.data()) % 64 == 0);
    std::int32_t offset[W];
    for (int k = 0; k < W; ++k) offset[k] = 4 * ((7 * k + 3) % 40);
    auto const packs = transpose_load<T, W>([&](int k) { return record<T>::load(column.data() + offset[k]); });
    for (int k = 0; k < W; ++k)
        for (int l = 0; l < 4; ++l) REQUIRE(packs[std::size_t(l)][k] == T(10 * ((7 * k + 3) % 40)) + T(l));
    std::vector<T> back(4 * W + 8, T(-7));
    transpose_store<T, W>(back.data() + 4, packs);
    for (int k = 0; k < W; ++k)
        for (int l = 0; l < 4; ++l) REQUIRE(back[std::size_t(4 + 4 * k + l)] == packs[std::size_t(l)][k]);
    for (std::size_t k = 0; k < 4; ++k) {
        REQUIRE(back[k] == T(-7));
        REQUIRE(back[back.size() - 1 - k] == T(-7));
    }
}

/// Entries of two records: number l of entry k is 10 k + l.
template <class T, int W>
void check_double_records() {
    particle_column<T> column(20);
    for (std::size_t k = 0; k < 20; ++k)
        for (int l = 0; l < 8; ++l) column.at(k, l) = T(10 * k) + T(l);
    REQUIRE(column.size() == 20);
    REQUIRE(column.of(3, 1)[2] == T(36));
    REQUIRE(column[3][2] == T(32));
    auto const packs = transpose_load2<T, W>([&]<int N>(int k, int first) {
        return pack<T, N>::load(column.data() + 8 * ((7 * k + 3) % 20) + first);
    });
    for (int k = 0; k < W; ++k)
        for (int l = 0; l < 8; ++l) REQUIRE(packs[std::size_t(l)][k] == T(10 * ((7 * k + 3) % 20)) + T(l));
    column.set(3, record<T>(T(-1)), 1);
    REQUIRE(column.at(3, 3) == T(33));
    REQUIRE(column.at(3, 4) == T(-1));
    REQUIRE(column.at(3, 7) == T(-1));
    REQUIRE(column.at(4, 0) == T(40));
}

template <class T>
struct three_fields {
    T one;
    vec<T, 2> two;
};

} // namespace

TEST_CASE("packs compute lane by lane", "[pack]") {
    check_pack<double, 2>();
    check_pack<double, 4>();
    check_pack<double, 8>();
    check_pack<float, 4>();
    check_pack<float, 8>();
    check_pack<float, 16>();
}

TEST_CASE("records are transposed into packs and back", "[records]") {
    check_records<double, 2>();
    check_records<double, 4>();
    check_records<double, 8>();
    check_records<float, 4>();
    check_records<float, 8>();
    check_records<float, 16>();
}

TEST_CASE("entries of two records are transposed into packs", "[records]") {
    check_double_records<double, 2>();
    check_double_records<double, 4>();
    check_double_records<double, 8>();
    check_double_records<float, 4>();
    check_double_records<float, 8>();
    check_double_records<float, 16>();
}

TEST_CASE("fields of aggregates, packed and converted", "[fields]") {
    static_assert(field_count<three_fields, double> == 3);
    field_packs<three_fields, float, 4> rows;
    rows.resize(3);
    for (std::size_t k = 0; k < 12; ++k) rows.set(k, {float(k), {float(100 + k), float(200 + k)}});
    for (std::size_t k = 0; k < 12; ++k) {
        REQUIRE(rows.get(k).one == float(k));
        REQUIRE(rows.get(k).two[1] == float(200 + k));
        REQUIRE(rows.load(k / 4).two[0][int(k % 4)] == float(100 + k));
    }
    auto middle = rows.load(1);
    middle.two[0] = middle.two[0] * pack<float, 4>(2.0f);
    rows.store(1, middle);
    REQUIRE(rows.get(5).two[0] == 210);
    REQUIRE(rows.get(3).two[0] == 103);
    REQUIRE(rows.get(8).two[0] == 108);
    auto const wide = convert_fields<double, float, three_fields<double>>(rows.get(5), [](float x) { return 3.0 * x; });
    REQUIRE(wide.one == 15);
    REQUIRE(wide.two[1] == 615);
}

TEST_CASE("short vectors", "[vec]") {
    vec<double, 3> const a{1, 2, 3}, b{-4, 5, 0.5};
    REQUIRE(a + b == vec<double, 3>{-3, 7, 3.5});
    REQUIRE(a - b == vec<double, 3>{5, -3, 2.5});
    REQUIRE(-a == vec<double, 3>{-1, -2, -3});
    REQUIRE(a * 2.0 == vec<double, 3>{2, 4, 6});
    REQUIRE(2.0 * a == a * 2.0);
    REQUIRE(a / 2.0 == vec<double, 3>{0.5, 1, 1.5});
    REQUIRE(dot(a, b) == 7.5);
    REQUIRE(cross(a, b) == vec<double, 3>{-14, -12.5, 13});
    REQUIRE(cross(vec<double, 2>{1, 2}, vec<double, 2>{3, 4}) == -2);
    REQUIRE(perpendicular(vec<double, 2>{1, 2}) == vec<double, 2>{-2, 1});
    REQUIRE(norm(vec<double, 2>{3, -4}) == 5);
    REQUIRE(norm(vec<double, 1>{-4}) == 4);
    REQUIRE(squared_norm(a) == 14);
    REQUIRE(select(true, a, b) == a);
    REQUIRE_FALSE(a == b);
    vec<double, 4> c{1, 2, 3, 4};
    c += vec<double, 4>{1, 1, 1, 1};
    c -= vec<double, 4>{0, 0, 0, 5};
    c *= 2.0;
    REQUIRE(c == vec<double, 4>{4, 6, 8, 0});
}

TEST_CASE("clipping keeps the direction", "[vec]") {
    REQUIRE(clip_norm(vec<double, 1>{-4}, 3.0)[0] == -3);
    REQUIRE(clip_norm(vec<double, 1>{4}, 3.0)[0] == 3);
    REQUIRE(clip_norm(vec<double, 1>{-2}, 3.0)[0] == -2);
    REQUIRE(clip_norm(vec<double, 1>{5}, 0.0)[0] == 0);
    auto const c = clip_norm(vec<double, 3>{0, 6, 8}, 5.0);
    REQUIRE_THAT(c[1], WithinRel(3.0, 1e-15));
    REQUIRE_THAT(c[2], WithinRel(4.0, 1e-15));
    REQUIRE(clip_norm(vec<double, 3>{0, 3, 4}, 5.0) == vec<double, 3>{0, 3, 4});
    REQUIRE(clip_norm(vec<double, 3>{0, 0, 0}, 0.0) == vec<double, 3>{0, 0, 0});
    REQUIRE(clip_norm(vec<double, 3>{0, 3, 4}, 0.0) == vec<double, 3>{0, 0, 0});
}

TEST_CASE("dual numbers differentiate", "[dual]") {
    using two = dual<double, 2>;
    two const x = two::variable(3, 0), y = two::variable(-2, 1);
    auto const check = [](two const& f, double value, double dx, double dy) {
        REQUIRE_THAT(f.value, WithinAbs(value, 1e-14));
        REQUIRE_THAT(f.derivative[0], WithinAbs(dx, 1e-14));
        REQUIRE_THAT(f.derivative[1], WithinAbs(dy, 1e-14));
    };
    check(x + y, 1, 1, 1);
    check(x - y, 5, 1, -1);
    check(-x, -3, -1, 0);
    check(x * y, -6, -2, 3);
    check(x / y, -1.5, -0.5, -0.75);               // 1/y, -x/y^2
    check(two(2) * x + 1.0, 7, 2, 0);
    check(sqrt(x * x + y * y), std::sqrt(13.0), 3 / std::sqrt(13.0), -2 / std::sqrt(13.0));
    check(abs(y), 2, 0, -1);
    check(min(x, y), -2, 0, 1);
    check(max(x, y), 3, 1, 0);
    check(select(x < y, x, y), -2, 0, 1);
    check(sqrt(x - 3.0), 0, 0, 0);                 // by convention at the kink
    two z = x;
    z += y;
    z *= x;
    z -= y;
    check(z, 5, 2 * 3 - 2, 3 - 1);                 // x^2 + x y - y
    REQUIRE((x > y && y < x && x >= x && x <= x));
}

TEST_CASE("messages of refused values", "[error]") {
    double const nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    REQUIRE_THROWS_WITH(require_positive("a.b", 0.0), "a.b = 0: must be > 0 and finite");
    REQUIRE_THROWS_WITH(require_positive("a.b", inf), "a.b = inf: must be > 0 and finite");
    REQUIRE_THROWS_WITH(require_positive("a.b", 5e-324),
                        "a.b = 4.94066e-324: must be at least 1e-300"); // its inverse is infinite
    REQUIRE_THROWS_WITH(require_not_negative("a", -0.1), "a = -0.1: must be >= 0 and finite");
    REQUIRE_THROWS_WITH(require_limit("a", nan), "a = nan: must be >= 0");
    REQUIRE_THROWS_WITH(require_in("a", 1.5, 0, 1), "a = 1.5: must be from 0 to 1");
    REQUIRE_THROWS_AS(require_finite("a", nan), std::invalid_argument);
    REQUIRE_NOTHROW(require_limit("a", inf));
    REQUIRE_NOTHROW(require_in("a", 1, 0, 1));
    REQUIRE(to_text(0.1) == "0.1");
    REQUIRE(std::stod(to_text(1.0 / 3)) == 1.0 / 3);
    unstable_run const u("text", 7, 3);
    REQUIRE(u.step() == 7);
    REQUIRE(u.particle() == 3);
}
