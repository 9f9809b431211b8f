#include "tools/view/page.h"

#include "tools/cli/file_input.h"
#include "tools/cli/html.h"
#include "tools/commands.h"

#include <filesystem>

namespace acdf::tools {
namespace {

namespace fs = std::filesystem;

constexpr char mark[] = "<!-- OPENED -->";

} // namespace

std::string viewer_page() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const std::string path = (program.parent_path() / ACDF_VIEWER_PAGE).lexically_normal().string();
    if (error || !fs::exists(path, error))
        throw Failure(path +
                      ": the viewer's page was not built with this acdf (it needs a compiler for WebAssembly: see "
                      "docs/web.md); acdf plot makes a picture");
    const std::vector<std::uint8_t> bytes = read_bytes(path);
    std::string page(bytes.begin(), bytes.end());
    if (page.find(mark) == std::string::npos)
        throw Failure(path + ": is not a page of this version; install acdf again");
    return page;
}

std::string page_with(std::string page, const std::string& name, const std::vector<std::uint8_t>& bytes) {
    const std::string element = "<script type=\"text/plain\" id=\"opened\" data-name=\"" + escaped(name) + "\">" +
                                base64(bytes) + "</script>";
    return page.replace(page.find(mark), sizeof mark - 1, element);
}

} // namespace acdf::tools
