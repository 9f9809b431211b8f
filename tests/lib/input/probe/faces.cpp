// Cubes whose faces are six files, strips, or mip-mapped OpenEXR files.
#include "input/probe/faces.h"
#include "input/probe/image_header.h"
#include "input/probe/source.h"
#include "input/sha256.h"
#include "tests/lib/input/write.h"

#include <gtest/gtest.h>

namespace {

using namespace acdf::input;
using namespace acdf::test;

constexpr int kSide = 32;

/// A face as a graphics library defines it: the centre, where its columns go and where its rows go.
struct Face {
    Vec centre, right, down;
};
using Cube = std::array<Face, 6>; // +X -X +Y -Y +Z -Z

// OpenGL 4.6, table 8.19, and Direct3D 11.3, 7.18.11: s and t of the major axis, rows of t from the top.
const Cube kGraphics = {{{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                         {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                         {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                         {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                         {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},
                         {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}}};

// ImfEnvmap.h, ENVMAP_CUBE.
const Cube kOpenExr = {{{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                        {{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                        {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
                        {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                        {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}},
                        {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}}}};

/// A convention as docs/conventions.md has it: our direction of its (X, Y, Z), and where texel centres are.
struct Convention {
    const char* name;
    const Cube& cube;
    Vec (*ours)(Vec);
    bool centres_on_borders;
};

Vec ours_of_directx(Vec d) { return {d.z, -d.x, d.y}; }
Vec ours_of_opengl(Vec d) { return {d.z, d.x, d.y}; }

const Convention kConventions[] = {{"directx", kGraphics, ours_of_directx, false},
                                   {"opengl", kGraphics, ours_of_opengl, false},
                                   {"openexr", kOpenExr, ours_of_opengl, true}};

Pixels face_of(const Convention& convention, std::size_t number) {
    Pixels face{kSide, kSide, std::vector<float>(std::size_t{3} * kSide * kSide)};
    const auto& [centre, right, down] = convention.cube[number];
    const auto place = [&](int i) {
        return convention.centres_on_borders ? 2.0 * i / (kSide - 1) - 1.0 : (2.0 * i + 1.0) / kSide - 1.0;
    };
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const auto value = sky(convention.ours(normalized(centre + place(x) * right + place(y) * down)));
            for (std::size_t c = 0; c < 3; ++c) face.at(x, y)[c] = static_cast<float>(value[c]);
        }
    return face;
}

void write_face(const std::string& path, const Convention& convention, std::size_t number) {
    write_rgb(path, face_of(convention, number));
}

/// As one source, in the order of `numbers`.
std::string write_faces(const Folder& folder, const Convention& convention, const std::array<int, 6>& numbers) {
    std::string source;
    for (const int number : numbers) {
        const std::string path = folder / ("face" + std::to_string(source.size()) + ".exr");
        write_face(path, convention, static_cast<std::size_t>(number));
        source += (source.empty() ? "" : ",") + path;
    }
    return source;
}

Probe read_with(const std::string& source, const std::string& faces) {
    ProbeOptions options;
    options.faces.emplace();
    EXPECT_TRUE(parse_faces(faces, *options.faces)) << faces;
    return read_probe(source, options);
}

std::string refused_with(const std::string& source, const std::string& faces,
                         Projection projection = Projection::automatic) {
    ProbeOptions options;
    options.projection = projection;
    if (!faces.empty()) {
        EXPECT_TRUE(parse_faces(faces, options.faces.emplace()));
    }
    try {
        read_probe(source, options);
    } catch (const Error& error) {
        return error.what();
    }
    ADD_FAILURE() << source << " was read";
    return {};
}

void expect_sky(const Probe& probe) {
    EXPECT_EQ(probe.projection, Projection::cube_cross);
    ASSERT_EQ(probe.width, 4 * kSide);
    const Pixels expected = latlong_sky(4 * kSide);
    double squares = 0.0;
    for (std::size_t i = 0; i < expected.rgb.size(); ++i) {
        const double error = (probe.rgb[i] - expected.rgb[i]) / expected.rgb[i];
        squares += error * error;
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(expected.rgb.size())), 0.025);
}

TEST(InputFaces, SixFilesInEachConvention) {
    const Folder folder;
    for (const Convention& convention : kConventions) {
        SCOPED_TRACE(convention.name);
        const std::string source = write_faces(folder, convention, {0, 1, 2, 3, 4, 5});
        const Probe probe = read_with(source, convention.name);
        expect_sky(probe);
        EXPECT_EQ(probe.projection_reason, std::string("--faces ") + convention.name);
        const ImageSize size = image_size(source);
        EXPECT_EQ(size.width, 4 * kSide);
        EXPECT_EQ(size.height, 3 * kSide);
    }
}

TEST(InputFaces, AnyOrderOfFilesUnderAnyName) {
    const Folder folder;
    const std::string source = write_faces(folder, kConventions[0], {4, 5, 1, 0, 2, 3});
    for (const char* const order :
         {"+z,-z,-x,+x,+y,-y", "pz,nz,nx,px,py,ny", "POSZ,NEGZ,NEGX,POSX,POSY,NEGY",
          "front,back,left,right,up,down", "front,back,left,right,top,bottom", "ft,bk,lf,rt,up,dn"}) {
        SCOPED_TRACE(order);
        expect_sky(read_with(source, order));
    }
    Faces faces;
    for (const char* const order :
         {"", "vulkan", "+x,-x,+y,-y,+z", "+x,-x,+y,-y,+z,+z", "+x,-x,+y,-y,+z,-z,+x", "+x,-x,+y,-y,+z,w", ",,,,,"})
        EXPECT_FALSE(parse_faces(order, faces)) << order;
}

TEST(InputFaces, Strips) {
    const Folder folder;
    for (const Convention& convention : kConventions)
        for (const int columns : {1, 2, 3, 6}) {
            SCOPED_TRACE(std::string(convention.name) + " in columns: " + std::to_string(columns));
            Pixels strip{columns * kSide, 6 / columns * kSide, std::vector<float>(std::size_t{18} * kSide * kSide)};
            for (int i = 0; i < 6; ++i) {
                const Pixels face = face_of(convention, static_cast<std::size_t>(i));
                for (int y = 0; y < kSide; ++y)
                    std::copy_n(face.at(0, y), 3 * kSide, strip.at(i % columns * kSide, i / columns * kSide + y));
            }
            write_rgb(folder / "strip.exr", strip);
            expect_sky(read_with(folder / "strip.exr", convention.name));
        }
}

TEST(InputFaces, WhatIsNoCubeIsRefused) {
    const Folder folder;
    const std::string source = write_faces(folder, kConventions[0], {0, 1, 2, 3, 4, 5});
    EXPECT_CONTAINS(refused_with(source, ""), "--faces");
    EXPECT_CONTAINS(refused_with(source, "directx", Projection::latlong), "--faces");
    const std::string third = probe_files(source)[2];
    write_rgb(third, {16, 16, std::vector<float>(3 * 16 * 16, 1.0f)});
    std::string text = refused_with(source, "directx");
    EXPECT_EQ(text.rfind(third, 0), 0u) << text;
    EXPECT_CONTAINS(text, "16x16 is not as large");
    write_rgb(third, {32, 16, std::vector<float>(3 * 32 * 16, 1.0f)});
    EXPECT_CONTAINS(refused_with(source, "directx"), "not square, as the faces of a cube are");
    std::filesystem::remove(third);
    text = refused_with(source, "directx");
    EXPECT_EQ(text.rfind(third, 0), 0u) << text;
    write_rgb(folder / "map.exr", latlong_sky(32));
    EXPECT_CONTAINS(refused_with(folder / "map.exr", "directx"), "32x16 is not a strip");
}

TEST(InputFaces, SixFilesAreOneSource) {
    const Folder folder;
    const std::string source = write_faces(folder, kConventions[0], {0, 1, 2, 3, 4, 5});
    const Probe probe = read_with(source, "directx");
    std::string digests, names;
    for (const std::string& file : probe_files(source)) {
        digests += file_sha256(file) + "\n";
        names += (names.empty() ? "" : ",") + std::filesystem::path(file).filename().string();
    }
    EXPECT_EQ(probe.source_sha256, text_sha256(digests, ""));
    EXPECT_EQ(probe.source_name, names);
    EXPECT_EQ(with_paths("a,b,c,d,e,f", [](const std::string& path) { return "in/" + path; }),
              "in/a,in/b,in/c,in/d,in/e,in/f");
    // A name with commas is that of a file, if there is one.
    const std::string commas = folder / "a,b,c,d,e,f.exr";
    write_rgb(commas, latlong_sky(16));
    EXPECT_EQ(probe_files(commas), std::vector<std::string>{commas});
    EXPECT_EQ(read_probe(commas).width, 16);
}

TEST(InputFaces, MipMappedOpenExr) {
    const Folder folder;
    Pixels cube{kSide, 6 * kSide, {}};
    for (std::size_t i = 0; i < 6; ++i) {
        const Pixels face = face_of(kConventions[2], i);
        cube.rgb.insert(cube.rgb.end(), face.rgb.begin(), face.rgb.end());
    }
    OIIO::ImageSpec spec = rgb_spec(cube);
    spec.attribute("textureformat", "CubeFace Environment");
    write_image(folder / "one.exr", spec, cube.rgb);
    spec.tile_width = spec.tile_height = 64;
    spec.attribute("openexr:levelmode", 1); // MIPMAP_LEVELS
    const auto out = OIIO::ImageOutput::create("many.exr");
    ASSERT_TRUE(out->open(folder / "many.exr", spec)) << out->geterror();
    ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, cube.rgb.data()));
    for (int width = kSide / 2, height = 3 * kSide; height > 0; width /= 2, height /= 2) {
        spec.width = spec.full_width = std::max(width, 1);
        spec.height = spec.full_height = height;
        ASSERT_TRUE(out->open(folder / "many.exr", spec, OIIO::ImageOutput::AppendMIPLevel)) << out->geterror();
        const std::vector<float> level(static_cast<std::size_t>(3 * spec.width * spec.height), 9.0f);
        ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, level.data())) << out->geterror();
    }
    ASSERT_TRUE(out->close());
    const Probe probe = read_probe(folder / "many.exr");
    expect_sky(probe);
    EXPECT_EQ(probe.rgb, read_probe(folder / "one.exr").rgb);
    EXPECT_TRUE(probe.warnings.empty()) << probe.warnings[0];
    ProbeOptions options;
    options.projection = Projection::cube_cross;
    EXPECT_EQ(read_probe(folder / "many.exr", options).rgb, probe.rgb);
}

} // namespace
