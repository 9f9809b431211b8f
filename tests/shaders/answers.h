// What devices read and answer: files of numbers in a folder.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace acdf_test {

template <class T>
std::vector<T> read_all(const std::string& path, std::size_t count) {
    std::vector<T> values(count);
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (!file || std::fread(values.data(), sizeof(T), count, file) != count) {
        std::fprintf(stderr, "%s: cannot read %zu values\n", path.c_str(), count);
        std::exit(1);
    }
    std::fclose(file);
    return values;
}

template <class T>
void write_all(const std::string& path, const std::vector<T>& values) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file || std::fwrite(values.data(), sizeof(T), values.size(), file) != values.size() || std::fclose(file)) {
        std::fprintf(stderr, "%s: cannot write\n", path.c_str());
        std::exit(1);
    }
}

} // namespace acdf_test
