// Codec 2 of format/SPEC.md §7.4: a tree taken apart into planes, which deflate better.
#include "curves/functions.h"
#include "inflate.h"

#include <acdf/curves/tree.h>

#include <cstdlib>
#include <cstring>

namespace acdf {
namespace {

constexpr u32 value_sizes[ACDF_PLANE_STREAMS] = ACDF_PLANE_VALUE_SIZES;

void store_value(u8* at, u32 value, u32 size) {
    for (u32 i = 0; i < size; ++i) at[i] = static_cast<u8>(value >> 8 * i);
}

/// One stream of values. Its bytes lie in planes: the lowest byte of every value, then the next one of every value.
struct Stream {
    const u8* data = nullptr;
    u32 count = 0, size = 1, next = 0;

    bool has(u32 n) const { return n <= count - next; }
    u32 at(u32 i) const {
        u32 value = 0;
        for (u32 byte = 0; byte < size; ++byte) value |= u32{data[u64{byte} * count + i]} << 8 * byte;
        return value;
    }
    u32 take() { return at(next++); }
};

/// A curve some of whose children are still to come.
struct OpenCurve {
    u64 at = 0;    ///< of the curve
    u64 links = 0; ///< of its array of links
    u32 link_size = 0, segments = 0;
    const Stream* children = nullptr; ///< the segments that are refined, in the order of their subtrees
    u32 next = 0, end = 0;            ///< in `children`
};

class Decoder {
public:
    Decoder(u8* tree, u64 size) : tree_(tree), size_(size) {}

    bool open_streams(const u8* planes, u64 size) {
        AcdfPlanes head;
        if (size < sizeof head) return false;
        std::memcpy(&head, planes, sizeof head);
        u64 at = sizeof head;
        for (int i = 0; i < ACDF_PLANE_STREAMS; ++i) {
            const u32 value_size = value_sizes[i];
            streams_[i] = {planes + (at < size ? at : size), head.count[i], value_size, 0};
            at += u64{head.count[i]} * value_size;
        }
        return at == size;
    }

    bool run() {
        std::memset(tree_, 0, size_);
        for (u64 at = 0; at < size_;)
            if (!link_from_parent(at) || !decode_curve(at)) return false;
        for (const Stream& stream : streams_)
            if (stream.next != stream.count) return false;
        return open_count_ == 0;
    }

private:
    /// Writes the link that leads to the curve at `at`, unless that is a root.
    bool link_from_parent(u64 at) {
        if (open_count_ == 0) return true;
        OpenCurve& parent = open_[open_count_ - 1];
        const u32 segment = parent.children->at(parent.next);
        const u64 distance = (at - parent.at) / 2;
        if (segment >= parent.segments || distance > 0xFFFFFFFFu >> (32 - 8 * parent.link_size)) return false;
        u8* const link = tree_ + parent.links + u64{segment} * parent.link_size;
        for (u32 i = 0; i < parent.link_size; ++i)
            if (link[i] != 0) return false; // it has a child
        store_value(link, static_cast<u32>(distance), parent.link_size);
        if (++parent.next == parent.end) --open_count_;
        return true;
    }

    /// Decodes the curve at `at`, in bytes, and moves behind it.
    bool decode_curve(u64& at) {
        const u64 begin = at;
        Stream& headers = streams_[ACDF_PLANE_HEADERS];
        if (!headers.has(1)) return false;
        const u32 header = headers.take();
        if (!put(at, header, 2)) return false;
        u32 segments = header >> ACDF_CURVE_SEGMENTS_SHIFT;
        if (segments == 0) {
            if (!streams_[ACDF_PLANE_SEGMENTS].has(1)) return false;
            segments = streams_[ACDF_PLANE_SEGMENTS].take();
            if (segments == 0 || !put(at, segments, 4)) return false;
        }
        if (!put_sums(at, segments - 1, ACDF_PLANE_CUMULATIVE, ACDF_CURVE_CUMULATIVE_CODE(header)) ||
            !put_sums(at, segments - 1, ACDF_PLANE_POSITIONS, ACDF_CURVE_POSITION_CODE(header)))
            return false;
        if (ACDF_CURVE_LINK_CODE(header) != 0 &&
            !open_links(begin, at, segments, acdf_element_size(ACDF_CURVE_LINK_CODE(header) - 1)))
            return false;
        at = acdf_align(at, 2);
        if (header & ACDF_CURVE_TILTED) {
            Stream& tilts = streams_[ACDF_PLANE_TILTS];
            if (!tilts.has(segments)) return false;
            for (u32 i = 0; i < segments; ++i)
                if (!put(at, tilts.take(), 2)) return false;
        }
        return at <= size_;
    }

    bool put(u64& at, u32 value, u32 size) {
        if (at > size_ || size > size_ - at) return false;
        store_value(tree_ + at, value, size);
        at += size;
        return true;
    }

    /// An array of which the stream of its size holds the differences.
    bool put_sums(u64& at, u32 count, int first_stream, u32 code) {
        if (code > 2) return false;
        Stream& stream = streams_[first_stream + static_cast<int>(code)];
        at = acdf_align(at, stream.size);
        if (!stream.has(count)) return false;
        for (u32 i = 0, sum = 0; i < count; ++i)
            if (!put(at, sum += stream.take(), stream.size)) return false;
        return true;
    }

    /// Leaves room for links; link_from_parent fills them in.
    bool open_links(u64 begin, u64& at, u32 segments, u32 link_size) {
        Stream& children = streams_[segments <= 0xFF ? ACDF_PLANE_CHILDREN : ACDF_PLANE_CHILDREN + 1];
        at = acdf_align(at, link_size);
        if (!children.has(1)) return false;
        const u32 count = children.take();
        const u64 bytes = u64{segments} * link_size;
        if (!children.has(count) || at > size_ || bytes > size_ - at) return false;
        if (count > 0) {
            if (open_count_ == ACDF_MAX_DEPTH) return false;
            open_[open_count_++] = {
                begin, at, link_size, segments, &children, children.next, children.next + count};
        }
        children.next += count;
        at += bytes;
        return true;
    }

    u8* tree_;
    u64 size_;
    Stream streams_[ACDF_PLANE_STREAMS];
    OpenCurve open_[ACDF_MAX_DEPTH];
    u32 open_count_ = 0;
};

/// Puts the tree of `tree_size` bytes at `tree` (aligned to 4) together from `size` bytes of planes. False where
/// they are not the planes of a tree of that size; `tree` then holds anything. Whether the tree itself keeps the
/// rules is for others to check. Reads and writes nothing else, allocates nothing; linear in both sizes.
bool planes_to_tree(const u8* planes, u64 size, u8* tree, u64 tree_size) {
    Decoder decoder(tree, tree_size);
    return decoder.open_streams(planes, size) && decoder.run();
}

} // namespace

int inflate_planes(const u8* bytes, u64 bytes_size, u8* tree, u64 tree_size, const char** wrong) {
    u64 size = 2 * tree_size + sizeof(AcdfPlanes); // more than those of any tree
    auto* planes = static_cast<u8*>(std::malloc(size));
    *wrong = "no memory for its planes";
    if (!planes) return 1003;
    *wrong = inflate_within(bytes, bytes_size, planes, size);
    if (!*wrong && !planes_to_tree(planes, size, tree, tree_size))
        *wrong = "its planes are not those of such a tree";
    std::free(planes);
    return *wrong ? 4005 : 0;
}

} // namespace acdf
