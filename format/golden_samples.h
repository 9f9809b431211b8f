// What is sampled from a golden file, as the text that is frozen beside it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// A line a sample, as format/make_golden.cpp tells. `name`: of the file, for errors. Throws std::runtime_error
/// where the reader refuses it.
std::string golden_samples(const std::string& name, const std::vector<std::uint8_t>& bytes);
