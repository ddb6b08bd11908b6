// SPDX-License-Identifier: BSD-3-Clause
#include "own_model.hpp"

int main(int argc, char**) {
    lacuna::simulation<own_model> const* none = nullptr; // the program has to link, not to run
    return argc > 1 ? int(count(*none)) : 0;
}
