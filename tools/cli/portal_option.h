// Windows that light comes through: --portal and --portals.
#pragma once

#include <acdf/builder.h>

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace acdf::tools {

struct PortalOption {
    std::string path; ///< a scene of acdf render, for Conversion::files; empty: none

    bool given() const { return !corners_.empty() || !path.empty(); }
    void add(CLI::App& command, const char* group);
    /// The options in one spelling, with the SHA-256 of the file. Throws input::Error.
    std::string text() const;
    /// Adds the portals to visibility, whose transform is known. Throws input::Error.
    void tell(builder::Visibility& visibility) const;

private:
    std::vector<builder::Portal> corners_;
    std::vector<std::string> spelled_; ///< of these
};

} // namespace acdf::tools
