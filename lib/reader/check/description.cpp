// What the file says about itself: DESC, META, and what its kind asks of them.
#include "check/checker.h"
#include "utf8.h"

#include <cmath>
#include <cstring>

namespace acdf {

namespace {

constexpr u32 max_environment_resolution = 65536;
constexpr u32 max_metadata_pairs = 1024; // so that comparing all keys stays linear in the bytes
constexpr u32 max_key_bytes = 255;

// What is wrong with an axis name; null if nothing.
const char* name_fault(const u8 (&name)[16]) {
    u64 length = 0;
    while (length < sizeof name && name[length] != 0) ++length;
    if (length == 0) return "it is empty";
    for (u64 i = length; i < sizeof name; ++i)
        if (name[i] != 0) return "bytes follow its end";
    return is_utf8(name, length) ? nullptr : "it is not UTF-8";
}

void check_axes(const Payload& payload, u32 count, const AcdfAxis* axes, Report& report) {
    bool sampled = false;
    for (u32 i = 0; i < count; ++i) {
        const AcdfAxis& axis = axes[i];
        const u64 at = payload.at(sizeof(AcdfDescription) + i * sizeof(AcdfAxis));
        const char* fault = name_fault(axis.name);
        for (u32 j = 0; j < i && !fault; ++j)
            if (std::memcmp(axes[j].name, axis.name, sizeof axis.name) == 0) fault = "an axis before it has it too";
        if (fault) report.add(5011, at, "the name of axis %u: %s", i, fault);
        if (axis.role > ACDF_AXIS_INDEXED)
            report.add(5012, at + offsetof(AcdfAxis, role), "axis %u: role %u is unknown", i, axis.role);
        else sampled = sampled || axis.role == ACDF_AXIS_SAMPLED;
        if (axis.measure > ACDF_MEASURE_HALF)
            report.add(5013, at + offsetof(AcdfAxis, measure), "axis %u: measure %u is unknown", i, axis.measure);
        if (axis.resolution < 1 || axis.resolution > most_steps)
            report.add(5014, at + offsetof(AcdfAxis, resolution), "axis %u has %u steps", i, axis.resolution);
        if (axis.reserved != 0)
            report.add(5008, at + offsetof(AcdfAxis, reserved), "`reserved` of axis %u is not zero", i);
        if (!std::isfinite(axis.low) || !std::isfinite(axis.high) || axis.low == axis.high)
            report.add(5015, at + offsetof(AcdfAxis, low), "axis %u has no finite range", i);
    }
    if (!sampled) report.add(5012, payload.at(sizeof(AcdfDescription)), "no axis is sampled");
}

struct Choice {
    const char* name;
    int rule;
    std::size_t offset;
    u32 low, high; // the known values
};

constexpr Choice choices[] = {
    {"parameterization", 5001, offsetof(AcdfDescription, parameterization), ACDF_PARAM_LATLONG,
     ACDF_PARAM_OCTAHEDRAL},
    {"fit", 5002, offsetof(AcdfDescription, fit), ACDF_FIT_UNIFORM, ACDF_FIT_VARIANCE},
    {"filter", 5003, offsetof(AcdfDescription, filter), ACDF_FILTER_NEAREST, ACDF_FILTER_BILINEAR},
    {"channels", 5019, offsetof(AcdfDescription, channels), ACDF_CHANNELS_WEIGHTED, ACDF_CHANNELS_LARGEST},
    {"up_axis", 5004, offsetof(AcdfDescription, up_axis), ACDF_UP_Z, ACDF_UP_Z},
    {"handedness", 5005, offsetof(AcdfDescription, handedness), ACDF_RIGHT_HANDED, ACDF_RIGHT_HANDED},
};

bool goes_with(u32 parameterization, u32 kind) {
    if (kind == ACDF_KIND_BRDF) return parameterization == ACDF_PARAM_HALF_ANGLE;
    if (kind == ACDF_KIND_TABLE) return parameterization == ACDF_PARAM_TABLE;
    return parameterization == ACDF_PARAM_LATLONG || parameterization == ACDF_PARAM_OCTAHEDRAL;
}

void check_fields(const Payload& payload, const AcdfDescription& d, u32 kind, Report& report) {
    for (const Choice& choice : choices) {
        u32 value;
        std::memcpy(&value, payload.data + choice.offset, sizeof value);
        if (value < choice.low || value > choice.high)
            report.add(choice.rule, payload.at(choice.offset), "`%s` %u is unknown", choice.name, value);
    }
    if (kind >= ACDF_KIND_ENVIRONMENT && kind <= ACDF_KIND_INDEXED && d.parameterization >= ACDF_PARAM_LATLONG &&
        d.parameterization <= ACDF_PARAM_OCTAHEDRAL && !goes_with(d.parameterization, kind))
        report.add(5016, payload.at(0), "parameterization %u with kind %u", d.parameterization, kind);
    if (d.bin_count < 1) report.add(5007, payload.at(offsetof(AcdfDescription, bin_count)), "there is no bin");
    for (u32 i = 0; i < 3; ++i)
        if (!std::isfinite(d.channel_weights[i]) || d.channel_weights[i] < 0.0)
            report.add(5009, payload.at(offsetof(AcdfDescription, channel_weights) + 8 * i),
                       "channel weight %u is not finite or negative", i);
    if (!std::isfinite(d.total) || !(d.total > 0.0))
        report.add(5010, payload.at(offsetof(AcdfDescription, total)), "`total` is not finite and positive");
}

constexpr WantedAxis latlong_axes[2] = {
    {"phi", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, ACDF_PI, -ACDF_PI, max_environment_resolution},
    {"theta", ACDF_AXIS_SAMPLED, ACDF_MEASURE_COSINE, 0.0, ACDF_PI, max_environment_resolution}};
constexpr WantedAxis octahedral_axes[2] = {
    {"u", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, 0.0, 1.0, max_environment_resolution},
    {"v", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, 0.0, 1.0, max_environment_resolution}};

// ---- metadata -------------------------------------------------------------------------------------------

struct Key {
    const u8* data;
    u64 size;
};

bool any_equal(const Key* keys, u32 count, const Key& key) {
    for (u32 i = 0; i < count; ++i)
        if (keys[i].size == key.size && std::memcmp(keys[i].data, key.data, key.size) == 0) return true;
    return false;
}

// Reads one length and that many bytes at `at`; null, or what is wrong.
const char* read_text(const Payload& payload, u64& at, Key& text) {
    if (payload.size - at < 4) return "the chunk ends before a length";
    text.size = load_u32(payload.data + at);
    at += 4;
    if (payload.size - at < text.size) return "a text ends after the chunk";
    text.data = payload.data + at;
    at += text.size;
    return is_utf8(text.data, text.size) ? nullptr : "a text is not UTF-8";
}

} // namespace

void check_description(const Payload& payload, u32 kind, Report& report, Parts& parts) noexcept {
    if (payload.size < sizeof(AcdfDescription)) {
        report.add(4004, payload.at(0), "DESC has %llu bytes", static_cast<ull>(payload.size));
        return;
    }
    const AcdfDescription& d = *reinterpret_cast<const AcdfDescription*>(payload.data);
    const AcdfAxis* axes = reinterpret_cast<const AcdfAxis*>(payload.data + sizeof d);
    check_fields(payload, d, kind, report);
    if (d.axis_count < 1 || d.axis_count > ACDF_MAX_AXES) {
        report.add(5006, payload.at(offsetof(AcdfDescription, axis_count)), "there are %u axes, not 1 to 8",
                   d.axis_count);
        return;
    }
    if (payload.size != sizeof d + d.axis_count * sizeof(AcdfAxis)) {
        report.add(4004, payload.at(0), "DESC has %llu bytes for %u axes", static_cast<ull>(payload.size),
                   d.axis_count);
        return;
    }
    check_axes(payload, d.axis_count, axes, report);
    parts.description = &d;
    parts.axes = axes;
}

void check_metadata(const Payload& payload, Report& report, Parts& parts) noexcept {
    Key keys[max_metadata_pairs];
    const u32 count = payload.size >= 4 ? load_u32(payload.data) : 0;
    u64 at = 4;
    if (payload.size < 4 || count > max_metadata_pairs) {
        report.add(5017, payload.at(0), "META has no room for its count, or more than 1024 pairs");
        return;
    }
    for (u32 i = 0; i < count; ++i) {
        const u64 start = at;
        Key value;
        const char* fault = read_text(payload, at, keys[i]);
        if (!fault && (keys[i].size < 1 || keys[i].size > max_key_bytes)) fault = "the key is empty or too long";
        if (!fault) fault = read_text(payload, at, value);
        if (fault) {
            report.add(5017, payload.at(start), "pair %u of META: %s", i, fault);
            return;
        }
        if (any_equal(keys, i, keys[i]))
            report.add(5018, payload.at(start), "pair %u of META has the key of one before", i);
    }
    if (at != payload.size) {
        report.add(5017, payload.at(at), "bytes are left over in META");
        return;
    }
    parts.metadata = payload.data + 4;
    parts.metadata_count = count;
}

const char* axis_fault(const AcdfAxis& axis, const WantedAxis& wanted) noexcept {
    if (std::strncmp(reinterpret_cast<const char*>(axis.name), wanted.name, sizeof axis.name) != 0) return "name";
    if (axis.role != wanted.role) return "role";
    if (axis.measure != wanted.measure) return "measure";
    if (axis.low != wanted.low || axis.high != wanted.high) return "range";
    return axis.resolution > wanted.most ? "resolution" : nullptr;
}

void check_environment_axes(const Payload& payload, Report& report, const Parts& parts) noexcept {
    const bool octahedral = parts.description->parameterization == ACDF_PARAM_OCTAHEDRAL;
    for (u32 i = 0; i < 2; ++i)
        if (const char* fault = axis_fault(parts.axes[i], (octahedral ? octahedral_axes : latlong_axes)[i]))
            report.add(7001, payload.at(sizeof(AcdfDescription) + i * sizeof(AcdfAxis)),
                       "axis %u is not that of an environment: the %s differs", i, fault);
}

void check_environment(const Payload& payload, const Payload& bins, Report& report, const Parts& parts) noexcept {
    const AcdfDescription& d = *parts.description;
    if (d.axis_count != 2)
        report.add(7001, payload.at(offsetof(AcdfDescription, axis_count)), "an environment with %u axes",
                   d.axis_count);
    else check_environment_axes(payload, report, parts);
    if (d.bin_count != 1)
        report.add(7002, payload.at(offsetof(AcdfDescription, bin_count)), "an environment with %u bins",
                   d.bin_count);
    if (!parts.bins || d.bin_count != 1) return;
    const float share = parts.bins[0].share;
    if (std::isfinite(share) && share >= 0.0f && share != 1.0f) // else rule 6017
        report.add(7008, bins.at(offsetof(AcdfBin, share)), "the share of an environment's bin is not 1");
}

} // namespace acdf
