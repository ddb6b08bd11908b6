// SPDX-License-Identifier: BSD-3-Clause
//
// A yardstick: one fully bonded regular sheet, written by hand for this case. One array per quantity, one loop over
// pairs and one loop over particles that gathers the forces of its pairs. Both have no branch, and the compiler
// vectorises them. There are no neighbour lists, no materials and no history but the forces. It shows the speed of such
// a loop here.
//
//   bench_plain_kernel [particles [seconds [double|float]]]: prints one line of JSON

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace {

template <class Real>
class plain_sheet {
public:
    explicit plain_sheet(std::size_t particles) {
        columns_ = std::max(3, int(std::sqrt(double(particles))));
        rows_ = int((particles + std::size_t(columns_) - 1) / std::size_t(columns_));
        n_ = std::size_t(columns_) * std::size_t(rows_);
        for (auto* column : {&x_, &y_, &vx_, &vy_, &spin_, &load_, &free_}) column->assign(n_, Real(0));
        radius_.assign(n_, Real(0.5));
        for (std::size_t k = 0; k < n_; ++k) {
            int const row = int(k) / columns_, column = int(k) % columns_;
            x_[k] = Real(column + 0.5 * (row % 2));
            y_[k] = Real(row * std::sqrt(0.75));
            free_[k] = row > 0 ? Real(1) : Real(0);
            load_[k] = row == rows_ - 1 ? Real(-1e-4) : Real(0);
        }
        connect();
    }

    std::size_t size() const { return n_; }
    std::size_t pairs() const { return first_.size(); }

    void step(Real dt) {
        pair_forces(dt);
        move(dt);
    }

    double kinetic_energy() const {
        double sum = 0;
        for (std::size_t k = 0; k < n_; ++k)
            sum += 0.5 * double(vx_[k] * vx_[k] + vy_[k] * vy_[k]) + 0.0625 * double(spin_[k] * spin_[k]);
        return sum;
    }

private:
    void connect() {
        auto const join = [&](std::size_t a, std::size_t b) {
            first_.push_back(std::int32_t(a));
            second_.push_back(std::int32_t(b));
        };
        for (std::size_t k = 0; k < n_; ++k) {
            int const row = int(k) / columns_, column = int(k) % columns_;
            if (column + 1 < columns_) join(k, k + 1);
            if (row + 1 == rows_) continue;
            for (int const above : {column - 1 + row % 2, column + row % 2})
                if (above >= 0 && above < columns_)
                    join(k, std::size_t(row + 1) * std::size_t(columns_) + std::size_t(above));
        }
        // The pair after the last has no force: it fills the list of a particle with fewer than three pairs of a kind.
        std::size_t const none = pairs();
        for (auto* column : {&fx_, &fy_, &shear_}) column->assign(none + 1, Real(0));
        normal_.assign(none, Real(0));
        for (auto* column : {&normal_stiffness_, &shear_stiffness_}) column->assign(none, Real(1));
        for (auto* column : {&tensile_limit_, &shear_limit_}) column->assign(none, Real(1e9));
        std::vector<int> used(n_, 0), used_other(n_, 0);
        for (auto& list : own_) list.assign(n_, std::int32_t(none));
        for (auto& list : other_) list.assign(n_, std::int32_t(none));
        for (std::size_t p = 0; p < none; ++p) {
            auto const a = std::size_t(first_[p]), b = std::size_t(second_[p]);
            own_[used[a]++][a] = std::int32_t(p);
            other_[used_other[b]++][b] = std::int32_t(p);
        }
    }

    void pair_forces(Real dt) {
        auto const count = pairs();
        std::int32_t const *__restrict a = first_.data(), *__restrict b = second_.data();
        Real const *__restrict x = x_.data(), *__restrict y = y_.data(), *__restrict vx = vx_.data(),
                   *__restrict vy = vy_.data(), *__restrict w = spin_.data(), *__restrict r = radius_.data(),
                   *__restrict kn = normal_stiffness_.data(), *__restrict ks = shear_stiffness_.data(),
                   *__restrict tn = tensile_limit_.data(), *__restrict ts = shear_limit_.data();
        Real *__restrict fn = normal_.data(), *__restrict fs = shear_.data(), *__restrict fx = fx_.data(),
             *__restrict fy = fy_.data();
#pragma omp simd
        for (std::size_t p = 0; p < count; ++p) {
            auto const i = a[p], j = b[p];
            Real const dx = x[j] - x[i], dy = y[j] - y[i], one = Real(1) / std::sqrt(dx * dx + dy * dy);
            Real const nx = dx * one, ny = dy * one, ux = vx[j] - vx[i], uy = vy[j] - vy[i];
            Real const opening = ux * nx + uy * ny, sliding = uy * nx - ux * ny - (r[i] * w[i] + r[j] * w[j]);
            Real const trial = std::max(fn[p] + kn[p] * opening * dt, -tn[p]);
            Real const shear = fs[p] + ks[p] * sliding * dt;
            bool const broken = (trial > tn[p]) | (std::fabs(shear) > ts[p]);
            Real const normal = broken ? Real(0) : trial, tangential = broken ? Real(0) : shear;
            fn[p] = normal;
            fs[p] = tangential;
            fx[p] = normal * nx - tangential * ny;
            fy[p] = normal * ny + tangential * nx;
        }
    }

    void move(Real dt) {
        std::int32_t const *__restrict a = own_[0].data(), *__restrict b = own_[1].data(),
                           *__restrict c = own_[2].data(), *__restrict d = other_[0].data(),
                           *__restrict e = other_[1].data(), *__restrict f = other_[2].data();
        Real const *__restrict px = fx_.data(), *__restrict py = fy_.data(), *__restrict pt = shear_.data(),
                   *__restrict load = load_.data(), *__restrict mobile = free_.data(), *__restrict r = radius_.data();
        Real *__restrict x = x_.data(), *__restrict y = y_.data(), *__restrict vx = vx_.data(),
             *__restrict vy = vy_.data(), *__restrict w = spin_.data();
#pragma omp simd
        for (std::size_t k = 0; k < n_; ++k) {
            Real const sx = px[a[k]] + px[b[k]] + px[c[k]] - (px[d[k]] + px[e[k]] + px[f[k]]);
            Real const sy = py[a[k]] + py[b[k]] + py[c[k]] - (py[d[k]] + py[e[k]] + py[f[k]]) + load[k];
            Real const torque = r[k] * (pt[a[k]] + pt[b[k]] + pt[c[k]] + pt[d[k]] + pt[e[k]] + pt[f[k]]);
            Real const gain = mobile[k] * dt;
            vx[k] += sx * gain;
            vy[k] += sy * gain;
            w[k] += torque * gain * 8; // I = m r^2 / 2 = 1/8
            x[k] += vx[k] * dt;
            y[k] += vy[k] * dt;
        }
    }

    int columns_ = 0, rows_ = 0;
    std::size_t n_ = 0;
    std::vector<Real> x_, y_, vx_, vy_, spin_, radius_, load_, free_;
    std::vector<std::int32_t> first_, second_, own_[3], other_[3];
    std::vector<Real> normal_, shear_, fx_, fy_, normal_stiffness_, shear_stiffness_, tensile_limit_, shear_limit_;
};

template <class Real>
int run(std::size_t particles, double seconds, char const* name) {
    plain_sheet<Real> sheet(particles);
    using clock = std::chrono::steady_clock;
    auto const since = [](clock::time_point start) {
        return std::chrono::duration<double>(clock::now() - start).count();
    };
    auto const steps = [&](long long count) {
        auto const start = clock::now();
        for (long long s = 0; s < count; ++s) sheet.step(Real(0.05));
        return since(start);
    };
    double const one = steps(100) / 100;
    auto const count = std::max(20LL, (long long)(seconds / one));
    double const took = steps(count), energy = sheet.kinetic_energy();
    double const work = double(sheet.size()) * double(count);
    std::printf(
        "{\"work\": \"plain_kernel\", \"particles\": %zu, \"real\": \"%s\", \"ours\": %.6g, \"ns_per_pair\": %.4g, "
        "\"pairs\": %zu, \"steps\": %lld, \"kinetic_energy\": %.4g}\n",
        sheet.size(), name, work / took, took * 1e9 / double(count) / double(sheet.pairs()), sheet.pairs(), count,
        energy);
    return std::isfinite(energy) && energy > 0 ? 0 : 1;
}

} // namespace

int main(int count, char** arguments) {
    long const particles = count > 1 ? std::atol(arguments[1]) : 3200;
    double const seconds = count > 2 ? std::atof(arguments[2]) : 1;
    bool const single = count > 3 && std::strcmp(arguments[3], "float") == 0;
    if (particles < 9 || !(seconds > 0)) {
        std::fprintf(stderr, "usage: bench_plain_kernel [particles [seconds [double|float]]]\n");
        return 2;
    }
    return single ? run<float>(std::size_t(particles), seconds, "float")
                  : run<double>(std::size_t(particles), seconds, "double");
}
