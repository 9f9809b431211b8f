// Runs the tests of a program: all of them, or those of the sources that are named (absolute paths). Machines that
// build once have the tests of a folder in one program, and run by themselves those that belong together and share
// what is made once.
#include <cstdio>
#include <gtest/gtest.h>
#include <string>
#include <string_view>

namespace {

// The tests of a source, `:Suite.Test` each.
std::string tests_of(std::string_view source) {
    std::string tests;
    const testing::UnitTest& all = *testing::UnitTest::GetInstance();
    for (int i = 0; i < all.total_test_suite_count(); ++i) {
        const testing::TestSuite& suite = *all.GetTestSuite(i);
        for (int k = 0; k < suite.total_test_count(); ++k) {
            const testing::TestInfo& test = *suite.GetTestInfo(k);
            if (test.file() == source) {
                tests += std::string(":") + suite.name() + "." + test.name();
            }
        }
    }
    return tests;
}

} // namespace

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    std::string filter;
    for (int i = 1; i < argc; ++i) {
        filter += tests_of(argv[i]);
    }
    if (argc > 1) {
        if (filter.empty()) {
            std::fprintf(stderr, "no tests in these sources\n");
            return 1;
        }
        GTEST_FLAG_SET(filter, filter.substr(1));
    }
    return RUN_ALL_TESTS();
}
