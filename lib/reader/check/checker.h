// Inside the checks: what check*.cpp share. Not installed.
#pragma once

#include "check/check.h"

namespace acdf {

/// Collects findings: counts them, passes them to the sink, and falls silent once the sink says stop.
class Report {
public:
    Report(FindingSink sink, void* context) noexcept : sink_(sink), context_(context) {}

#ifdef ACDF_ENVIRONMENT_ONLY
    /// Details are left out.
#if defined(__GNUC__)
    __attribute__((noinline, cold))
#endif
    void
    add(int rule, u64 offset) noexcept;
    template <class... Details>
    void add(int rule, u64 offset, const Details&...) noexcept {
        add(rule, offset);
    }
#else
#if defined(__GNUC__)
    __attribute__((format(printf, 4, 5)))
#endif
    void
    add(int rule, u64 offset, const char* format, ...) noexcept;
#endif

    bool stopped() const noexcept { return stopped_; }
    const Verdict& verdict() const noexcept { return verdict_; }

private:
    FindingSink sink_;
    void* context_;
    Verdict verdict_;
    bool stopped_ = false;

    void pass(const Finding& finding) noexcept;
};

constexpr u32 most_steps = 0x7FFFFFFF; ///< of an axis (rule 5014)

inline u64 round_up(u64 n, u64 to) noexcept { return (n + to - 1) / to * to; }

/// DESC. Sets parts.description and parts.axes if its length is right.
ACDF_ONCE void check_description(const Payload& payload, u32 kind, Report& report, Parts& parts) noexcept;
/// META. Sets parts.metadata if it is well-formed.
ACDF_ONCE void check_metadata(const Payload& payload, Report& report, Parts& parts) noexcept;
/// HALV: one tree, or of tables, whose `bins` is BINS, one for each bin with a share; needs parts.description, and
/// parts.bins of tables. Sets parts.halvings.
void check_halvings(const Payload& payload, const Payload* bins, Report& report, const AcdfAllocator& allocator,
                    Parts& parts) noexcept;
/// What an axis must be.
struct WantedAxis {
    const char* name;
    u32 role, measure;
    double low, high;
    u32 most; ///< steps
};
/// What of an axis differs; null: nothing.
ACDF_ONCE const char* axis_fault(const AcdfAxis& axis, const WantedAxis& wanted) noexcept;

/// What the kind asks of axes and bins; needs parts.description. Axes 0 and 1 must be those of an environment.
ACDF_ONCE void check_environment_axes(const Payload& payload, Report& report, const Parts& parts) noexcept;
ACDF_ONCE void check_environment(const Payload& description, const Payload& bins, Report& report,
                                 const Parts& parts) noexcept;
/// COMP, where there is one; needs parts.description. Sets parts.partner.
ACDF_ONCE void check_partner(const Payload& payload, u32 kind, Report& report, Parts& parts) noexcept;

} // namespace acdf

/// A file that has no HALV, but for DESC and META unchecked: for AcdfCurves::check.
struct AcdfUncheckedFile {
    const acdf::Payloads& payloads;
    acdf::u32 kind;
    acdf::Report& report;
    acdf::Parts& parts; ///< what is right is set
};
