// Images that we write, as OpenImageIO reads them.
#include "images/openexr.h"
#include "images/png.h"
#include "tests/lib/input/write.h"

#include <cmath>
#include <fstream>
#include <limits>

namespace acdf::test {
namespace {

using images::Note;
using images::Picture;

struct Stored {
    OIIO::ImageSpec spec;
    std::vector<float> values;
};

Stored stored(const std::string& path, const std::vector<std::uint8_t>& bytes, OIIO::TypeDesc type) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
    if (!input) throw std::runtime_error(OIIO::geterror());
    Stored out{input->spec(), {}};
    EXPECT_EQ(out.spec.format, type);
    out.values.resize(out.spec.image_pixels() * static_cast<std::size_t>(out.spec.nchannels));
    EXPECT_TRUE(input->read_image(0, 0, 0, out.spec.nchannels, OIIO::TypeDesc::FLOAT, out.values.data()))
        << input->geterror();
    return out;
}

/// Random where `noise` is 1, smooth in different ways where it is 0: rows for each of PNG's filters.
Picture picture(int width, int height, int channels, double noise) {
    Picture out(width, height, channels);
    std::uint32_t random = 1;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) {
                random = random * 1664525u + 1013904223u;
                const int kind = y / 8 % 4;
                const double smooth = kind == 0   ? x * 0.01
                                      : kind == 1 ? y * 0.01 + (x * 7 % 11) * 0.05
                                      : kind == 2 ? (x + y) * 0.004 + 0.1 * c
                                                  : 0.3;
                out.at(x, y)[c] =
                    static_cast<float>(smooth + noise * (std::ldexp(static_cast<double>(random), -32) - smooth));
            }
    return out;
}

class WrittenImages : public testing::Test {
protected:
    Folder folder;
    std::string png = folder / "a.png", exr = folder / "a.exr";
    std::vector<Note> notes{{"Software", "acdf"}, {"Description", "h\xC3\xB6lzern, 10 sr^-1"}};

    void expect_kept(const Picture& rgb) {
        const Stored read = stored(png, images::encode_png(rgb, notes), OIIO::TypeDesc::UINT8);
        EXPECT_EQ(read.spec.width, rgb.width);
        EXPECT_EQ(read.spec.height, rgb.height);
        EXPECT_EQ(read.spec.nchannels, 3);
        EXPECT_EQ(read.spec.get_string_attribute("oiio:ColorSpace"), "sRGB");
        EXPECT_EQ(read.spec.get_string_attribute("Software"), notes[0].text);
        EXPECT_EQ(read.spec.get_string_attribute("ImageDescription"), notes[1].text);
        ASSERT_EQ(read.values.size(), rgb.values.size());
        for (std::size_t i = 0; i < read.values.size(); ++i) {
            const float shown =
                rgb.values[i] > 0.0f ? std::min(rgb.values[i], 1.0f) : 0.0f; // 0 where it is no number
            ASSERT_NEAR(255.0f * read.values[i], 255.0f * shown, 0.5001f) << i;
        }
    }
};

TEST_F(WrittenImages, PngsKeepTheirPixelsToEightBits) {
    expect_kept(picture(1, 1, 3, 0.0));
    expect_kept(picture(2, 37, 3, 0.0));
    for (const double noise : {0.0, 0.02, 1.0}) expect_kept(picture(320, 200, 3, noise)); // up to three chunks
}

TEST_F(WrittenImages, PngsClampWhatCannotBeShown) {
    Picture odd(4, 1);
    odd.values = {-1.0f,
                  0.0f,
                  2.0f,
                  std::numeric_limits<float>::quiet_NaN(),
                  1.0f,
                  std::numeric_limits<float>::infinity(),
                  -std::numeric_limits<float>::infinity(),
                  0.5f,
                  1e-9f,
                  0.25f,
                  0.75f,
                  0.9999f};
    expect_kept(odd);
}

TEST_F(WrittenImages, PngsAreTheSameEachTimeAndSmallerThanTheirPixels) {
    const Picture smooth = picture(320, 200, 3, 0.0);
    EXPECT_EQ(images::encode_png(smooth, notes), images::encode_png(smooth, notes));
    EXPECT_LT(images::encode_png(smooth, notes).size(), smooth.values.size() / 20);
}

TEST_F(WrittenImages, ExrsKeepTheirFloats) {
    const std::vector<std::string> rgb{"R", "G", "B"}, one{"Y"};
    for (const auto& channels : {rgb, one})
        for (const auto& [width, height] :
             {std::pair{1, 1}, {33, 17}, {1024, 1025}}) { // the last by several threads
            const Picture written = picture(width, height, static_cast<int>(channels.size()), 0.5);
            const Stored read = stored(exr, images::encode_exr(written, channels, notes), OIIO::TypeDesc::FLOAT);
            EXPECT_EQ(read.spec.width, width);
            EXPECT_EQ(read.spec.height, height);
            EXPECT_EQ(read.spec.channelnames, channels);
            EXPECT_EQ(read.spec.get_string_attribute("compression"), "zip");
            EXPECT_EQ(read.spec.get_string_attribute("Software"), notes[0].text);
            EXPECT_EQ(read.spec.get_string_attribute("ImageDescription"), notes[1].text);
            EXPECT_EQ(read.values, written.values);
        }
}

} // namespace
} // namespace acdf::test
