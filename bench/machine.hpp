// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

/// \file
/// Facts about program and machine that belong to every result.

#ifndef LACUNA_BENCH_COMMIT
#define LACUNA_BENCH_COMMIT "unknown"
#endif
#ifndef LACUNA_BENCH_COMPILER
#define LACUNA_BENCH_COMPILER __VERSION__
#endif
#ifndef LACUNA_BENCH_FLAGS
#define LACUNA_BENCH_FLAGS "unknown"
#endif

namespace bench {

/// Name of the processor from Linux's /proc/cpuinfo; "unknown" elsewhere.
inline std::string cpu_name() {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/proc/cpuinfo", "r"), [](std::FILE* f) {
        return f ? std::fclose(f) : 0;
    });
    char line[256];
    while (file && std::fgets(line, sizeof line, file.get())) {
        std::string const text = line;
        auto const colon = text.find(": ");
        if (text.rfind("model name", 0) == 0 && colon != std::string::npos)
            return text.substr(colon + 2, text.size() - colon - 3);
    }
    return "unknown";
}

/// Memory in use at present, not at its peak, MiB; 0 without Linux's /proc. Freed memory that GNU's C library retains
/// is returned to the system first.
inline double resident_mb() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/proc/self/status", "r"), [](std::FILE* f) {
        return f ? std::fclose(f) : 0;
    });
    char line[256];
    long kilobytes = 0;
    while (file && std::fgets(line, sizeof line, file.get()))
        if (std::sscanf(line, "VmRSS: %ld kB", &kilobytes) == 1) break;
    return double(kilobytes) / 1024;
}

} // namespace bench
