// Files that break one rule each.
#pragma once

#include "tests/lib/reader/action.h"
#include "tests/lib/reader/builder.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <vector>

namespace acdf_test {

struct Case {
    int rule;
    const char* name;
    Action<Bytes()> make;
    acdf::Limits limits = {};
};

std::vector<Case> container_cases();
std::vector<Case> plane_cases();
std::vector<Case> partner_cases();
std::vector<Case> description_cases();
std::vector<Case> tree_cases();
std::vector<Case> table_cases();
std::vector<Case> brdf_cases();     ///< of kind 3
std::vector<Case> local_cases();    ///< of kind 2
std::vector<Case> halvings_cases(); ///< of kind 1 with HALV
std::vector<Case> indexed_cases();  ///< of kind 5, of tests/lib/indexed
std::vector<Case> normals_cases();  ///< of kind 2 with HALV

} // namespace acdf_test
