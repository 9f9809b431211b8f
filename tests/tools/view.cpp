// acdf view: the viewer's page with a file in it. A browser opens one in tests/web/viewer.sh.
#include "tests/tools/run.h"

#include <gtest/gtest.h>

namespace acdf::test {
namespace {

TEST(ViewCommand, WritesAPageThatHoldsTheFile) {
    const Folder folder;
    const std::string sky = folder / "a&b.acdf", page = folder / "page.html";
    write_bytes(sky, small_halvings());
    const Result made = run_acdf({"view", sky, "-o", page});
    if (made.code != 0) {
        EXPECT_EQ(made.code, 1);
        EXPECT_NE(made.err.find("viewer's page was not built"), std::string::npos) << made.err;
        GTEST_SKIP() << "the page was not built: no compiler for WebAssembly";
    }
    EXPECT_EQ(made.out, "");
    const std::string text = read_text(page);
    EXPECT_NE(text.find("<title>acdf viewer</title>"), std::string::npos);
    EXPECT_NE(text.find("id=\"opened\" data-name=\"a&amp;b.acdf\">q0FDREYg"), std::string::npos)
        << "and the magic of its bytes";
    EXPECT_EQ(text.find("src="), std::string::npos) << "nothing is fetched";
    EXPECT_EQ(run_acdf({"view", sky, "-o", page}).code, 1) << "it exists";
    EXPECT_EQ(run_acdf({"view", folder / "none.acdf", "-o", page, "-f"}).code, 1);
}

} // namespace
} // namespace acdf::test
