// The page of thumbnails that a batch writes.
#include "tests/tools/batch/files.h"
#include "tests/tools/run.h"

#include <gtest/gtest.h>

namespace acdf::test {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t out = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++out;
    return out;
}

TEST(BatchGallery, ShowsEveryFileAndWhatFailed) {
    const Folder folder;
    write_small_probe(folder / "a.pfm", 1);
    write_text(folder / "jobs.jsonl",
               "{\"source\": \"a.pfm\", \"output\": \"a<b>&.acdf\", \"options\": {\"cells\": 20}}\n"
               "{\"source\": \"a.pfm\", \"kind\": \"local\", \"output\": \"l.acdf\", "
               "\"options\": {\"budget\": \"12KiB\", \"normals\": \"2\"}}\n"
               "{\"source\": \"lambert\", \"kind\": \"brdf\", \"output\": \"m.acdf\", "
               "\"options\": {\"cells\": 20, \"views\": \"4\"}}\n"
               "{\"source\": \"a.pfm\", \"output\": \"f.acdf\", "
               "\"options\": {\"target-variance\": 1e-12, \"channel\": \"rgb\"}}\n");
    const Result made =
        run_acdf({"batch", folder / "jobs.jsonl", "-o", folder / "out", "--gallery", "--kind", "env", "-q"});
    EXPECT_EQ(made.code, 1); // the last one fails
    const std::string page = read_text(folder / "out/gallery.html");
    EXPECT_EQ(count(page, "<img "), 6u) << made.err; // source and pdf
    EXPECT_EQ(count(page, "alt=\"source of "), 3u);
    EXPECT_EQ(count(page, "<figure>"), 4u);
    EXPECT_EQ(count(page, "data:image/png;base64,iVBORw0KGgo"), 6u);
    EXPECT_EQ(count(page, "src=\"http"), 0u);
    EXPECT_EQ(count(page, "a<b>"), 0u); // names are text
    EXPECT_NE(page.find("<h2><bdi>a&lt;b&gt;&amp;.acdf</bdi></h2>"), std::string::npos);
    EXPECT_NE(page.find("3 files, 1 failed"), std::string::npos);
    EXPECT_NE(page.find("out of reach"), std::string::npos);
    const std::size_t policy = page.find("Content-Security-Policy\" content=\"default-src 'none'; img-src data:;");
    EXPECT_LT(policy, page.find("<style>")) << "it counts for what follows it";
    // Once more, all up to date but the last.
    EXPECT_EQ(run_acdf({"batch", folder / "jobs.jsonl", "-o", folder / "out", "--gallery", "-q"}).code, 1);
    EXPECT_EQ(count(read_text(folder / "out/gallery.html"), "<img "), 6u);
    EXPECT_EQ(run_acdf({"batch", folder / "jobs.jsonl", "-o", folder / "out", "--gallery", "--dry-run"}).code, 2);
}

TEST(BatchGallery, ReplacesNoPageOfOthers) {
    const Folder folder;
    write_small_probe(folder / "a.pfm", 1);
    std::filesystem::create_directory(folder / "out");
    write_text(folder / "out/gallery.html", "<!doctype html>\nmine");
    std::vector<std::string> arguments{"batch", folder / "a.pfm", "-o", folder / "out", "--gallery", "-q"};
    const Result refused = run_acdf(arguments);
    EXPECT_EQ(refused.code, 1);
    EXPECT_NE(refused.err.find("gallery.html: exists and was not made by acdf"), std::string::npos) << refused.err;
    EXPECT_EQ(read_text(folder / "out/gallery.html"), "<!doctype html>\nmine");
    EXPECT_FALSE(std::filesystem::exists(folder / "out/a.acdf")) << "nothing was started";
    arguments.push_back("--force");
    EXPECT_EQ(run_acdf(arguments).code, 0);
    EXPECT_EQ(count(read_text(folder / "out/gallery.html"), "<figure>"), 1u);

    std::filesystem::remove(folder / "out/gallery.html");
    std::filesystem::create_directory(folder / "out/gallery.html");
    const Result in_the_way = run_acdf(arguments);
    EXPECT_EQ(in_the_way.code, 1);
    EXPECT_NE(in_the_way.err.find("gallery.html: is a folder"), std::string::npos) << in_the_way.err;
}

TEST(BatchGallery, AReportIsPrintedWhereThePageCannotBeWritten) {
    const Folder folder;
    write_small_probe(folder / "a.pfm", 1);
    std::filesystem::create_directory(folder / "out");
    std::filesystem::create_symlink("nowhere/gallery.html", folder / "out/gallery.html");
    const Result made = run_acdf({"batch", folder / "a.pfm", "-o", folder / "out", "--gallery", "--json"});
    EXPECT_EQ(made.code, 1);
    EXPECT_EQ(lines_in(made.err), 1u) << made.err;
    EXPECT_NE(made.out.find("\"status\": \"done\""), std::string::npos) << made.out;
}

} // namespace
} // namespace acdf::test
