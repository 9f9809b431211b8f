// OpenEXR and Radiance files that are read without OpenImageIO: whatever a file holds, and however it is damaged,
// what comes of it is what OpenImageIO makes of it.
#include "images/image_file.h"
#include "images/radiance.h"
#include "tests/inputs/sanitized.h"
#include "tests/lib/input/write.h"

#include <array>
#include <cstdio>
#include <cstring>
#include <functional>
#include <random>
#include <utility>

namespace {

using namespace acdf;
using namespace acdf::test;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
using namespace std::string_literals;

/// What reading a file comes to, in bands.
struct Read {
    bool opened = false, done = true;
    images::Header header;
    std::vector<float> texels; ///< of all channels
    std::string error;
};

template <class ReadRows>
void read_bands(Read& out, const ReadRows& read) {
    const images::Window& data = out.header.data;
    const auto channels = static_cast<std::size_t>(out.header.channel_count);
    const auto width = static_cast<std::size_t>(data.width), height = static_cast<std::size_t>(data.height);
    if (data.width > 512 || data.height > 512) return; // of a damaged header
    out.texels.assign(channels * width * height, 77.0f);
    const auto pixel = static_cast<std::ptrdiff_t>(channels * sizeof(float)), row = pixel * data.width;
    const int step = out.header.tile_height > 0 ? 512 : 5;
    for (int y = 0; y < data.height && out.done; y += step)
        out.done = read({y, std::min(y + step, data.height), 0, out.header.channel_count, pixel, row},
                        out.texels.data() + channels * width * static_cast<std::size_t>(y));
}

Read read_with(const images::ImageReader& reader, const std::string& path) {
    Read out;
    const std::unique_ptr<void, void (*)(void*)> image(reader.open(path, 1, out.header, out.error), reader.close);
    out.opened = image != nullptr;
    if (!image) return out;
    read_bands(out,
               [&](const images::Rows& rows, float* to) { return reader.read(image.get(), rows, to, out.error); });
    return out;
}

/// As acdf reads it.
Read read_file(const std::string& path) {
    images::ImageFile file(path, 1);
    Read out;
    out.opened = file.is_open();
    out.header = file.header();
    if (out.opened) read_bands(out, [&](const images::Rows& rows, float* to) { return file.read(rows, to); });
    out.error = file.error();
    return out;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

void expect_same(const Read& ours, const Read& theirs) {
    EXPECT_EQ(ours.opened, theirs.opened) << theirs.error;
    EXPECT_EQ(ours.done, theirs.done) << theirs.error;
    if (!ours.opened || !ours.done) {
        EXPECT_EQ(ours.error, theirs.error);
    }
    if (!ours.opened || !theirs.opened) return;
    EXPECT_EQ(ours.header.format, theirs.header.format);
    EXPECT_EQ(ours.header.data, theirs.header.data);
    EXPECT_EQ(ours.header.display, theirs.header.display);
    EXPECT_EQ(ours.header.depth, theirs.header.depth);
    EXPECT_EQ(ours.header.tile_height, theirs.header.tile_height);
    EXPECT_EQ(ours.header.channels, theirs.header.channels);
    EXPECT_EQ(ours.header.deep, theirs.header.deep);
    EXPECT_EQ(ours.header.floating, theirs.header.floating);
    EXPECT_EQ(ours.header.sample_bytes, theirs.header.sample_bytes);
    if (ours.header.format == "openexr") { // of Radiance pictures OpenImageIO does not say them
        EXPECT_EQ(ours.header.chromaticities, theirs.header.chromaticities);
    }
    EXPECT_TRUE(!ours.done || !theirs.done || same_bits(ours.texels, theirs.texels));
}

/// Whether a file was refused for an attribute of its header that is said to be larger than what follows it, and
/// is.
bool claims_too_much(const Read& ours, const std::string& bytes) {
    unsigned long at = 0, claim = 0, left = 0;
    const char* form = "at byte %lu an attribute of its header claims %lu bytes, where %lu follow";
    if (ours.opened || std::sscanf(ours.error.c_str(), form, &at, &claim, &left) != 3) return false;
    EXPECT_EQ(at + 4 + left, bytes.size());
    EXPECT_GT(claim, left);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(static_cast<unsigned char>(bytes.at(at + i)), claim >> (8 * i) & 0xFF);
    return true;
}

constexpr int kImageWidth = 32, kImageHeight = 16;

std::vector<float> usual_texels(int channels) {
    std::vector<float> out(static_cast<std::size_t>(channels * kImageWidth * kImageHeight));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = 0.1f + static_cast<float>(i / 5 * 37 % 101);
    out[4] = 1e-30f, out[11] = 60000.0f, out[20] = 0.0f;
    return out;
}

ImageSpec usual_spec(int channels, TypeDesc type = TypeDesc::HALF) {
    return {kImageWidth, kImageHeight, channels, type};
}

class UsualImages : public testing::Test {
protected:
    Folder folder;
    std::string exr = folder / "a.exr", hdr = folder / "a.hdr";

    void write(const ImageSpec& spec) {
        write_image(exr, spec, usual_texels(spec.nchannels));
        expect_same(read_file(exr), read_with(images::module().reader, exr));
    }
    bool is_taken(const std::string& path) {
        const bool radiance = path == hdr;
        return read_with(radiance ? images::radiance_reader() : images::openexr_module().reader, path).opened;
    }
    /// Damages a file and compares, again and again.
    void damage(const std::string& path, std::size_t header, unsigned seed) {
        const std::string good = read_text(path), bad = folder / "bad";
        std::mt19937 random(seed);
        int refused = 0;
        const int times = acdf_test::kSanitized ? 40 : 200;
        for (int i = 0; i < times; ++i) {
            SCOPED_TRACE(i);
            std::string bytes = good;
            if (i % 8 == 7) bytes.resize(random() % bytes.size());
            else if (i % 2) bytes[header + random() % (bytes.size() - header)] = static_cast<char>(random());
            else bytes[random() % header] = static_cast<char>(random());
            write_text(bad, bytes);
            const Read ours = read_file(bad);
            refused += !ours.opened || !ours.done;
            if (!claims_too_much(ours, bytes)) expect_same(ours, read_with(images::module().reader, bad));
        }
        EXPECT_GT(refused, times / 20);
        EXPECT_LT(refused, times);
    }
};

TEST_F(UsualImages, OpenExr) {
    for (const char* compression : {"none", "rle", "zip", "zips", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"})
        for (const TypeDesc& type : {TypeDesc(TypeDesc::HALF), TypeDesc(TypeDesc::FLOAT)})
            for (const int channels : {3, 4}) {
                SCOPED_TRACE(compression);
                ImageSpec spec = usual_spec(channels, type);
                spec.attribute("compression", compression);
                write(spec);
                EXPECT_TRUE(is_taken(exr));
            }
    ImageSpec windows = usual_spec(3);
    windows.x = 5, windows.y = -3, windows.full_x = -1, windows.full_y = 2, windows.full_width = 40;
    windows.attribute("Orientation", 1);
    windows.attribute("oiio:ColorSpace", "Linear");
    windows.attribute("Software", "a test");
    write(windows);
    EXPECT_TRUE(is_taken(exr));
}

TEST_F(UsualImages, UnusualOpenExrIsLeftToOpenImageIO) {
    ImageSpec tiles = usual_spec(3), grey = usual_spec(1), layer = usual_spec(3), more = usual_spec(5),
              turned = usual_spec(3), map = usual_spec(3), mixed = usual_spec(3),
              integers = usual_spec(3, TypeDesc::UINT32);
    tiles.tile_width = tiles.tile_height = 16;
    grey.channelnames = {"Y"};
    layer.channelnames = {"a.R", "a.G", "a.B"};
    more.channelnames = {"R", "G", "B", "A", "Z"};
    turned.attribute("Orientation", 6);
    map.attribute("textureformat", "LatLong Environment");
    mixed.channelformats = {TypeDesc::HALF, TypeDesc::FLOAT, TypeDesc::HALF};
    for (const ImageSpec* spec : {&tiles, &grey, &layer, &more, &turned, &map, &mixed, &integers}) {
        write(*spec);
        EXPECT_FALSE(is_taken(exr)) << spec->nchannels;
    }
    // Attributes that OpenImageIO does not write, but takes for its own.
    ImageSpec border = usual_spec(3), gamma = usual_spec(3), space = usual_spec(3);
    border.attribute("abcd:SampleBorder", 1);
    gamma.attribute("abcd:Gamma", 2.0f);
    space.attribute("abcd:ColorSpace", "sRGB");
    for (const ImageSpec* spec : {&border, &gamma, &space}) {
        write(*spec);
        EXPECT_TRUE(is_taken(exr));
        std::string bytes = read_text(exr);
        bytes.replace(bytes.find("abcd:"), 4, "oiio");
        write_text(exr, bytes);
        EXPECT_FALSE(is_taken(exr));
        expect_same(read_file(exr), read_with(images::module().reader, exr));
    }
    write_text(exr, "no image");
    EXPECT_FALSE(is_taken(exr));
    expect_same(read_file(exr), read_with(images::module().reader, exr));
}

TEST_F(UsualImages, Radiance) {
    write_image(hdr, usual_spec(3, TypeDesc::FLOAT), usual_texels(3));
    ASSERT_TRUE(is_taken(hdr));
    const Read theirs = read_with(images::module().reader, hdr);
    expect_same(read_file(hdr), theirs);
    const std::string bytes = read_text(hdr);
    const std::string pixels = bytes.substr(bytes.find("+X 32\n") + 6), size = "-Y 16 +X 32\n";
    const std::string format = "FORMAT=32-bit_rle_rgbe\n";
    for (const std::string& head : {"#?RADIANCE\n" + format + "\n",
                                    "#?RADIANCE\n# by hand\nGAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\n" + format + "\n",
                                    "#?RADIANCE\n" + format + "EXPOSURE=          1.0000000000000\n\n",
                                    "#?RADIANCE\nrpict -av 0 0 0 -x=1\n\tpfilt -1\nnormpat\nSOFTWARE=hand\n" +
                                        format + "VIEW= -vtv -vp 1 2 3\n# " + std::string(150, 'x') + "\n\n"}) {
        write_text(hdr, head + size + pixels + "behind");
        EXPECT_TRUE(is_taken(hdr)) << head;
        expect_same(read_file(hdr), theirs);
    }
    for (const char* const order : {"-Y 16 -X 32\n", "+Y 16 -X 32\n", "+Y 16 +X 32\n", "+X 16 -Y 32\n",
                                    "-X 16 -Y 32\n", "-X 16 +Y 32\n", "+X 16 +Y 32\n"}) {
        write_text(hdr, "#?RADIANCE\n" + format + "\n" + order + pixels);
        EXPECT_TRUE(is_taken(hdr)) << order;
        expect_same(read_file(hdr), theirs); // as stored: who reads it turns it
        const images::ImageFile ours(hdr, 1);
        images::Header header;
        std::string error;
        const images::ImageReader& other = images::module().reader;
        const std::unique_ptr<void, void (*)(void*)> image(other.open(hdr, 1, header, error), other.close);
        EXPECT_EQ(ours.integer("Orientation", 0), other.integer(image.get(), "Orientation", 0)) << order;
    }
    write_text(hdr, bytes);
    // Rows in another order than they are stored in.
    images::ImageFile file(hdr, 1);
    std::vector<float> row(3 * kImageWidth);
    for (const int y : {7, 3, 4, 15}) {
        ASSERT_TRUE(file.read({y, y + 1, 0, 3, 12, 12 * kImageWidth}, row.data()));
        EXPECT_TRUE(same_bits(
            row, {theirs.texels.begin() + 3 * kImageWidth * y, theirs.texels.begin() + 3 * kImageWidth * (y + 1)}));
    }
}

TEST_F(UsualImages, UnusualRadianceIsLeftToOpenImageIO) {
    write_image(hdr, usual_spec(3, TypeDesc::FLOAT), usual_texels(3));
    const std::string bytes = read_text(hdr), pixels = bytes.substr(bytes.find("+X 32\n") + 6);
    const std::string begin = "#?RADIANCE\n", format = "FORMAT=32-bit_rle_rgbe\n", size = "-Y 16 +X 32\n";
    for (const std::string& head :
         {begin + "FORMAT=32-bit_rle_rgb\n\n" + size, begin + format + size, begin + format + "\n" + "-Y 0 +X 32\n",
          begin + format + "\n" + "-Y 99999999999 +X 32\n", format + "\n" + size, begin + format}) {
        write_text(hdr, head + pixels);
        EXPECT_FALSE(is_taken(hdr)) << head;
        expect_same(read_file(hdr), read_with(images::module().reader, hdr));
    }
    EXPECT_FALSE(is_taken(folder / ""));
}

// Whatever is in a header, pixels are those that OpenImageIO reads; where it reads none
// (tests/lib/input/radiance.cpp).
TEST_F(UsualImages, RadianceAsOpenImageIOReadsIt) {
    write_image(hdr, usual_spec(3, TypeDesc::FLOAT), usual_texels(3));
    const std::string bytes = read_text(hdr), pixels = bytes.substr(bytes.find("+X 32\n") + 6);
    const std::string begin = "#?RADIANCE\n", format = "FORMAT=32-bit_rle_rgbe\n", size = "-Y 16 +X 32\n";
    for (const std::string& head :
         {"#?RGBE\n" + format + "\n" + size, begin + format + "GAMMA=2.2\n\n" + size,
          begin + "GAMMA=0.5\n" + format + "\n" + size, begin + format + "COLORCORR=2 2 2\n\n" + size,
          begin + format + "gamma=2\n\n" + size, begin + format + "-v\n\n" + size}) {
        write_text(hdr, head + pixels);
        EXPECT_TRUE(is_taken(hdr)) << head;
        expect_same(read_file(hdr), read_with(images::module().reader, hdr));
    }
    // Rows that are not encoded.
    write_text(hdr, begin + format + "\n" + size + std::string(4 * kImageWidth * kImageHeight, '\x51'));
    EXPECT_TRUE(is_taken(hdr));
    expect_same(read_file(hdr), read_with(images::module().reader, hdr));
}

/// A picture of whole pixels, one after the other; where n > 1, n times.
struct WholePixels {
    int columns, rows;
    std::vector<std::pair<std::array<unsigned char, 4>, int>> pixels; ///< a run does not go on in the next row

    std::string head() const {
        return "#?RADIANCE\nrview -vf a\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(rows) + " +X " +
               std::to_string(columns) + "\n";
    }
    std::string written(bool encoded) const {
        std::string out = head();
        for (const auto& [pixel, count] : pixels) {
            const std::string text(pixel.begin(), pixel.end());
            out += text;
            for (int i = 1; i < count && !encoded; ++i) out += text;
            for (int left = encoded ? count - 1 : 0; left > 0; left >>= 8) // the least first
                out += {1, 1, 1, static_cast<char>(left & 255)};
        }
        return out;
    }
};

WholePixels older_picture() {
    return {300,
            3,
            {{{200, 100, 50, 129}, 300},
             {{128, 0, 0, 140}, 1},
             {{2, 200, 2, 44}, 257},
             {{9, 9, 255, 0}, 42},
             {{2, 2, 129, 44}, 2},
             {{128, 1, 1, 129}, 256},
             {{1, 255, 1, 255}, 42}}};
}

// Until 1991 Radiance encoded runs of whole pixels, which others write to this day. OpenImageIO reads them where
// nothing is encoded.
TEST_F(UsualImages, OlderRadiance) {
    const WholePixels picture = older_picture();
    write_text(hdr, picture.written(false));
    EXPECT_TRUE(is_taken(hdr));
    const Read plain = read_with(images::module().reader, hdr);
    ASSERT_TRUE(plain.opened && plain.done);
    expect_same(read_file(hdr), plain);
    const std::string encoded = picture.written(true);
    write_text(hdr, encoded);
    ASSERT_TRUE(is_taken(hdr));
    EXPECT_FALSE(read_with(images::module().reader, hdr).done);
    expect_same(read_file(hdr), plain);
    // Cut short anywhere, or with runs of nothing or beyond the row.
    for (std::size_t size = picture.head().size(); size < encoded.size(); ++size) {
        write_text(hdr, encoded.substr(0, size));
        EXPECT_FALSE(read_file(hdr).done) << size;
    }
    for (const std::string& run :
         {std::string("\1\1\1\1"), "\x80\0\0\x80\1\1\1\xff\1\1\1\1"s, "\x80\0\0\x80\1\1\1\0\1\1\1\0\1\1\1\1"s}) {
        write_text(hdr, picture.head() + run + encoded.substr(picture.head().size()));
        EXPECT_FALSE(read_file(hdr).done);
    }
}

TEST_F(UsualImages, DamagedOpenExr) {
    for (const char* compression : {"zip", "piz", "dwaa"}) {
        SCOPED_TRACE(compression);
        ImageSpec spec = usual_spec(3);
        spec.attribute("compression", compression);
        write_image(exr, spec, usual_texels(3));
        damage(exr, 350, 5);
    }
}

TEST_F(UsualImages, AttributesOfOpenExrBeyondTheFile) {
    write(usual_spec(3));
    const std::string good = read_text(exr);
    for (const std::string& attribute :
         {"channels\0chlist\0"s, "compression\0compression\0"s, "lineOrder\0lineOrder\0"s}) {
        std::string bytes = good;
        const std::size_t at = bytes.find(attribute);
        ASSERT_NE(at, std::string::npos);
        const std::size_t size = at + attribute.size(), left = bytes.size() - size - 4;
        const auto claim = [&](std::size_t claimed) {
            for (std::size_t i = 0; i < 4; ++i) bytes[size + i] = static_cast<char>(claimed >> (8 * i));
            write_text(exr, bytes);
            return read_file(exr);
        };
        const Read one_more = claim(left + 1), most = claim(0x7FFFFFFF);
        EXPECT_EQ(one_more.error, "at byte " + std::to_string(size) + " an attribute of its header claims " +
                                      std::to_string(left + 1) + " bytes, where " + std::to_string(left) +
                                      " follow");
        EXPECT_TRUE(claims_too_much(most, bytes));
        // What fits, and what is negative, is left to OpenEXR.
        for (const std::size_t fits : {left, std::size_t{0xFFFFFFFF}}) {
            const Read left_to_others = claim(fits);
            EXPECT_FALSE(claims_too_much(left_to_others, bytes));
            expect_same(left_to_others, read_with(images::module().reader, exr));
        }
    }
}

TEST_F(UsualImages, HeadersOfPartsOfOpenExrBeyondTheFile) {
    const std::string begin = "\x76\x2F\x31\x01\x02\x10\0\0"s, name = "name\0string\0\1\0\0\0a"s;
    const std::string too_large = "name\0string\0\0\0\0\x10"s;
    const auto refused = [&](const std::string& bytes) {
        write_text(exr, bytes);
        return claims_too_much(read_file(exr), bytes);
    };
    EXPECT_TRUE(refused(begin + name + "\0"s + too_large));
    EXPECT_FALSE(refused(begin + name + "\0"s + name + "\0\0"s + too_large)); // behind the last header
    EXPECT_FALSE(refused(begin + name + "\0"s + name));
    EXPECT_FALSE(refused(begin + name + std::string(300, 'n') + "\0"s + too_large)); // no name is as long
    EXPECT_FALSE(refused("\x76\x2F\x31\x02"s + begin.substr(4) + too_large));
    EXPECT_FALSE(refused(begin));
    EXPECT_FALSE(refused(begin.substr(0, 5)));
}

TEST_F(UsualImages, DamagedRadiance) {
    write_image(hdr, usual_spec(3, TypeDesc::FLOAT), usual_texels(3));
    damage(hdr, 80, 6);
}

} // namespace
