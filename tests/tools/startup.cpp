// What the program loads before it has anything to do: no library for images, until there is one.
#include "tests/inputs/paths.h"
#include "tests/inputs/sanitized.h"
#include "tests/tools/plot/files.h"
#include "tests/tools/run.h"
#include "tools/plot/legend.h"

#include <cstdlib>
#include <set>
#include <sstream>

namespace acdf::test {
namespace {

namespace fs = std::filesystem;

/// Names of the shared libraries that a run of the program loads, as the dynamic linker lists them (ld.so(8)).
std::set<std::string> loaded_by(const std::vector<std::string>& arguments) {
    const Folder folder;
    setenv("LD_DEBUG", "files", 1);
    setenv("LD_DEBUG_OUTPUT", (folder / "ld").c_str(), 1); // .PID is added
    const Result result = run_acdf(arguments, "0,0,1\n");
    unsetenv("LD_DEBUG");
    unsetenv("LD_DEBUG_OUTPUT");
    EXPECT_EQ(result.code, 0) << result.err;
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder / "")) {
        std::istringstream lines(read_text(entry.path()));
        for (std::string line; std::getline(lines, line);) {
            const std::size_t begin = line.find("file="), end = line.find(" [", begin);
            if (begin == std::string::npos || end == std::string::npos ||
                line.find("generating link map") == std::string::npos)
                continue;
            names.insert(fs::path(line.substr(begin + 5, end - begin - 5)).filename().string());
        }
    }
    return names;
}

bool has(const std::set<std::string>& names, const std::string& beginning) {
    const auto found = names.lower_bound(beginning);
    return found != names.end() && found->rfind(beginning, 0) == 0;
}

const char* const kModules[] = {acdf_test::kImagesModule, acdf_test::kOpenExrModule, acdf_test::kTextModule};

class Startup : public testing::Test {
protected:
    Folder folder;
    std::string sky = folder / "sky.acdf", image = folder / "sky.tif", exr = folder / "sky.exr",
                table = folder / "table.npy";

    void SetUp() override {
        write_bytes(sky, small_environment());
        std::string npy("\x93NUMPY\x01\x00\x76\x00", 10);
        npy += "{'descr': '<f4', 'fortran_order': False, 'shape': (4,), }";
        npy.resize(127, ' ');
        write_text(table, npy + "\n" + std::string("\0\0\x80\x3F\0\0\0\x40\0\0\x40\x40\0\0\x80\x40", 16)); // 1 to 4
    }
    /// 32 x 16 texels, as OpenImageIO alone reads them and as OpenEXR does.
    void write_images() {
        std::vector<float> rgb(32 * 16 * 3);
        for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = 1.0f + static_cast<float>(i / 3 % 7);
        write_rgb(image, 32, 16, rgb);
        write_rgb(exr, 32, 16, rgb);
    }
    /// The program as it is installed, in another folder.
    std::string copied_program() {
        fs::create_directories(folder / "moved/bin");
        fs::copy_file(acdf_test::kProgram, folder / "moved/bin/acdf");
        return folder / "moved/bin/acdf";
    }
    /// Where that one looks for a module.
    std::string place_of(const std::string& module) {
        const fs::path way = fs::path(module).lexically_relative(fs::path(acdf_test::kProgram).parent_path());
        const fs::path place = (fs::path(folder / "moved/bin") / way).lexically_normal();
        fs::create_directories(place.parent_path());
        return fs::canonical(place.parent_path()) / place.filename();
    }
    void expect_refused(const std::string& program, const std::string& why) {
        expect_refused(
            program, place_of(acdf_test::kImagesModule), why,
            {{"env", image, "-o", folder / "x.acdf", "-q"}, {"batch", image, "-o", folder / "out", "-q"}});
        expect_refused(program, place_of(acdf_test::kOpenExrModule), why,
                       {{"env", exr, "-o", folder / "x.acdf", "-q"},
                        {"plot", sky, "-o", folder / "x.exr", "-q"},
                        {"batch", exr, "-o", folder / "out", "-q"}});
        if (!tools::find_font().empty())
            expect_refused(program, place_of(acdf_test::kTextModule), why,
                           {{"plot", sky, "-o", folder / "x.png", "-q"}});
    }
    void expect_refused(const std::string& program, const std::string& module, const std::string& why,
                        const std::vector<std::vector<std::string>>& commands) {
        for (const std::vector<std::string>& command : commands) {
            const Result result = run_acdf(command, "", program);
            EXPECT_EQ(result.code, 1) << command[0];
            EXPECT_EQ(lines_in(result.err), 1u) << result.err;
            EXPECT_NE(result.err.find(module + ": "), std::string::npos) << result.err;
            EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
        }
        EXPECT_FALSE(fs::exists(folder / "x.acdf"));
        EXPECT_FALSE(fs::exists(folder / "x.png"));
        EXPECT_FALSE(fs::exists(folder / "x.exr"));
    }
};

TEST_F(Startup, LoadsNoLibraryForImagesWhereThereIsNone) {
    ACDF_NOT_SANITIZED();
    write_text(image, "never opened");
    const std::string map = folder / "sky.pfm"; // which needs no library
    write_rgb(map, 4, 2, std::vector<float>(24, 1.0f));
    const std::vector<std::string> commands[] = {
        {"--version"},
        {"--help"},
        {"env", "--help"},
        {"info", sky},
        {"validate", sky},
        {"sample", sky, "--count", "4"},
        {"pdf", sky},
        {"brdf", "ggx:alpha=0.5", "-o", folder / "ggx.acdf", "--budget", "4KiB", "-q"},
        {"table", table, "-o", folder / "table.acdf", "-q"},
        {"batch", image, "-o", folder / "out", "--dry-run"},
        {"env", map, "-o", folder / "map.acdf", "-q"},
        {"batch", map, "-o", folder / "out", "-q"},
    };
    for (const std::vector<std::string>& command : commands) {
        const std::set<std::string> names = loaded_by(command);
        EXPECT_TRUE(has(names, "libstdc++")) << command[0]; // the list is one
        EXPECT_FALSE(has(names, "libOpenImageIO")) << command[0];
        EXPECT_FALSE(has(names, "acdf_images")) << command[0];
        EXPECT_LT(names.size(), 20u) << command[0];
    }
}

TEST_F(Startup, LoadsThemWhereThereIs) {
    write_images();
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"env", image, "-o", folder / "x.acdf", "-q"},
          {"batch", image, "-o", folder / "out", "--dry-run", "--json"}}) {
        const std::set<std::string> names = loaded_by(command);
        EXPECT_TRUE(has(names, "libOpenImageIO")) << command[0];
        EXPECT_TRUE(has(names, "acdf_images")) << command[0];
        EXPECT_FALSE(has(names, "acdf_openexr")) << command[0];
    }
}

TEST_F(Startup, LoadsNoMoreThanOpenExrWhereThatIsEnough) {
    write_images();
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"env", exr, "-o", folder / "x.acdf", "-q"},
          {"batch", exr, "-o", folder / "out", "--dry-run", "--json"}}) {
        const std::set<std::string> names = loaded_by(command);
        EXPECT_TRUE(has(names, "acdf_openexr")) << command[0];
        EXPECT_FALSE(has(names, "acdf_images")) << command[0];
        EXPECT_LT(names.size(), 25u) << command[0];
    }
    const std::string hdr = folder / "sky.hdr";
    write_rgb(hdr, 32, 16, std::vector<float>(32 * 16 * 3, 1.0f));
    const std::set<std::string> names = loaded_by({"env", hdr, "-o", folder / "y.acdf", "-q"});
    EXPECT_FALSE(has(names, "acdf_")); // which needs neither
}

TEST_F(Startup, LoadsNoMoreThanAFontForAPicture) {
    const bool text = !tools::find_font().empty();
    const std::set<std::string> labelled = loaded_by({"plot", sky, "-o", folder / "x.png", "-q"});
    EXPECT_EQ(has(labelled, "acdf_text"), text);
    EXPECT_FALSE(has(labelled, "acdf_images"));
    EXPECT_FALSE(has(labelled, "acdf_openexr"));
    EXPECT_LT(labelled.size(), 25u);
    const std::set<std::string> plain = loaded_by({"plot", sky, "-o", folder / "y.png", "-q", "--no-legend"});
    EXPECT_FALSE(has(plain, "acdf_"));
    const std::set<std::string> floats = loaded_by({"plot", sky, "-o", folder / "x.exr", "-q"});
    EXPECT_TRUE(has(floats, "acdf_openexr"));
    EXPECT_FALSE(has(floats, "acdf_images"));
    EXPECT_FALSE(has(floats, "acdf_text"));
}

TEST_F(Startup, TheProgramAndItsModulesMayBeMovedTogether) {
    ACDF_NOT_SANITIZED();
    write_images();
    const std::string program = copied_program();
    for (const char* module : kModules) fs::copy_file(module, place_of(module));
    for (const std::string& probe : {image, exr}) {
        const Result result = run_acdf({"env", probe, "-o", folder / "x.acdf", "--force"}, "", program);
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(run_acdf({"env", probe, "-o", folder / "y.acdf", "--force"}).code, 0);
        EXPECT_EQ(read_text(folder / "x.acdf"), read_text(folder / "y.acdf"));
    }
}

TEST_F(Startup, AMissingModuleIsNamed) {
    write_images();
    const std::string program = copied_program();
    expect_refused(program, "No such file");
    EXPECT_EQ(run_acdf({"info", sky}, "", program).code, 0);
}

TEST_F(Startup, ADamagedModuleIsNamed) {
    write_images();
    const auto damage = [&](const std::string& bytes) {
        for (const char* module : kModules) write_text(place_of(module), bytes);
    };
    damage("no library");
    expect_refused(copied_program(), "too short");
    damage(std::string(4096, 'x'));
    expect_refused(folder / "moved/bin/acdf", "invalid ELF header");
}

TEST_F(Startup, AModuleOfAnotherVersionIsNamed) {
    write_images();
    for (const char* module : kModules) fs::copy_file(acdf_test::kOtherModule, place_of(module));
    expect_refused(copied_program(), "it is of version 0.0, not ");
}

} // namespace
} // namespace acdf::test
