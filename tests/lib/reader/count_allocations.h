// What the reader allocates: its calls are caught by the linker (--wrap), zlib's and the test's are not. For one
// source file of a program.
#pragma once

#include <cstdlib>

namespace {
bool counting = false;
std::size_t calls = 0, bytes_taken = 0;

void count(std::size_t bytes) {
    if (!counting) return;
    ++calls;
    bytes_taken += bytes;
}
} // namespace

extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t n, std::size_t size);
void* __real_aligned_alloc(std::size_t alignment, std::size_t size);
void* __wrap_malloc(std::size_t size) { return count(size), __real_malloc(size); }
void* __wrap_calloc(std::size_t n, std::size_t size) { return count(n * size), __real_calloc(n, size); }
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
    return count(size), __real_aligned_alloc(alignment, size);
}
}

namespace {

struct Counted {
    Counted() {
        calls = bytes_taken = 0;
        counting = true;
    }
    ~Counted() { counting = false; }
};

} // namespace
