// The module's memory. It holds few blocks at a time, so that a list of what is free serves it: the allocator of
// wasi-libc would be a tenth of the module.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

extern "C" char __heap_base; // where the linker ends

namespace {

constexpr std::size_t unit = 64, page = 65536; // unit: of sizes and of addresses

struct Block {
    std::size_t size; // with this, which takes a unit
    Block* next;      // free, too, at a higher address
};

Block* first_free = nullptr;

char* end_of(Block* block) { return reinterpret_cast<char*>(block) + block->size; }

// Makes one of two that follow each other.
void join(Block* block) {
    if (!block->next || end_of(block) != reinterpret_cast<char*>(block->next)) return;
    block->size += block->next->size;
    block->next = block->next->next;
}

void put_back(Block* block) {
    Block *below = nullptr, *above = first_free;
    for (; above && above < block; above = above->next) below = above;
    block->next = above;
    (below ? below->next : first_free) = block;
    join(block);
    if (below) join(below);
}

// False where the engine gives no more.
bool grow(std::size_t bytes) {
    static char* end = nullptr; // of what was asked for
    if (!end) end = &__heap_base + (0u - reinterpret_cast<std::uintptr_t>(&__heap_base)) % unit;
    const std::size_t pages = (bytes + page - 1) / page;
    const std::size_t before = __builtin_wasm_memory_grow(0, pages);
    if (before == SIZE_MAX) return false;
    auto* const block = reinterpret_cast<Block*>(end);
    end = reinterpret_cast<char*>((before + pages) * page);
    block->size = static_cast<std::size_t>(end - reinterpret_cast<char*>(block));
    put_back(block);
    return true;
}

} // namespace

extern "C" void* aligned_alloc(std::size_t, std::size_t size) {
    if (size > SIZE_MAX / 2) return nullptr;
    const std::size_t wanted = (size + unit - 1) / unit * unit + unit;
    do
        for (Block** at = &first_free; *at; at = &(*at)->next) {
            Block* const block = *at;
            if (block->size < wanted) continue;
            if (block->size == wanted) *at = block->next;
            else {
                auto* const rest = reinterpret_cast<Block*>(reinterpret_cast<char*>(block) + wanted);
                *rest = {block->size - wanted, block->next};
                block->size = wanted;
                *at = rest;
            }
            return reinterpret_cast<char*>(block) + unit;
        }
    while (grow(wanted));
    return nullptr;
}
extern "C" void* malloc(std::size_t size) { return aligned_alloc(unit, size); }
extern "C" void* calloc(std::size_t count, std::size_t size) {
    void* const memory = size && count > SIZE_MAX / size ? nullptr : malloc(count * size);
    return memory ? std::memset(memory, 0, count * size) : nullptr;
}
extern "C" void free(void* memory) {
    if (memory) put_back(reinterpret_cast<Block*>(static_cast<char*>(memory) - unit));
}
extern "C" void* realloc(void* memory, std::size_t size) {
    void* const larger = malloc(size);
    if (!larger || !memory) return larger;
    const std::size_t held = (reinterpret_cast<Block*>(static_cast<char*>(memory) - unit))->size - unit;
    std::memcpy(larger, memory, held < size ? held : size);
    free(memory);
    return larger;
}
