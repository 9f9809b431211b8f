// Which channels are taken for the light, by the names of layers and parts.
#include "input/probe/layers.h"
#include "tests/lib/input/write.h"

#include <gtest/gtest.h>

namespace {

using namespace acdf::input;
using namespace acdf::test;

using Names = std::vector<std::string>;

/// The channels of layers, each with R, G and B; "" has none before them.
Names rgb_of(const Names& layers) {
    Names out;
    for (const std::string& layer : layers)
        for (const char* channel : {"R", "G", "B"}) out.push_back(layer.empty() ? channel : layer + "." + channel);
    return out;
}

Choice of_channels(const Names& channels) { return choose_layer({{0, "", channels}}); }
Choice of_layers(const Names& layers) { return of_channels(rgb_of(layers)); }

/// The layer that is chosen, or the error.
std::string chosen(const Names& layers) {
    const Choice choice = of_layers(layers);
    if (!choice.error.empty()) return choice.error;
    EXPECT_TRUE(choice.channels.in_order());
    return layers[static_cast<std::size_t>(choice.channels.index[0] / 3)];
}

TEST(Layers, TheWholePictureIsChosenWhereverItStands) {
    for (const char* whole : {"", "Combined", "ViewLayer.Combined", "RGBA", "rgba", "beauty", "Beauty", "C", "Ci",
                              "color", "Render.beauty", "View Layer.Combined", "Final_Image"})
        for (const char* other :
             {"AO", "ViewLayer.AO", "diffuse", "ViewLayer.DiffDir", "a.light", "zenith", "N", "crypto_asset00",
              "ViewLayer.CryptoObject00", "albedo", "rgba_key", "beauty_raw"}) {
            EXPECT_EQ(chosen({whole, other}), whole) << other;
            EXPECT_EQ(chosen({other, whole}), whole) << other;
        }
    EXPECT_EQ(chosen({"ViewLayer.Combined", "Composite.Combined"}), "Composite.Combined");
}

TEST(Layers, WhatIsNoLightIsNeverChosen) {
    for (const char* other : {"AO",
                              "ViewLayer.AO",
                              "Ambient Occlusion",
                              "crypto_object",
                              "cryptomatte00",
                              "uCryptoAsset",
                              "Depth",
                              "ZDepth",
                              "Z",
                              "Normal",
                              "N",
                              "Denoising Normal",
                              "Position",
                              "P",
                              "UV",
                              "Vector",
                              "Mist",
                              "IndexOB",
                              "ObjectID",
                              "material_id",
                              "MaterialID",
                              "id",
                              "ViewLayer.DiffCol",
                              "albedo",
                              "Denoising Albedo",
                              "motionVector",
                              "Shadow",
                              "matte",
                              "depth.left",
                              "AO.rgb"}) {
        EXPECT_NE(of_layers({other}).error.find("where R, G, B or a single one is needed"), std::string::npos)
            << other;
        EXPECT_EQ(chosen({other, "sky"}), "sky") << other;
        EXPECT_EQ(chosen({"sky", other}), "sky") << other;
    }
}

TEST(Layers, OfThoseThatAreAsGoodNoneIsChosen) {
    for (const auto& [first, second] : {std::pair{"Sky.Combined", "Ground.Combined"},
                                        {"diffuse", "specular"},
                                        {"RGBA_key", "RGBA_fill"},
                                        {"rgba.left", "rgba.right"},
                                        {"rgba", "beauty"},
                                        {"key_A", "key_B"}}) {
        const std::string error = of_layers({"AO", first, second}).error;
        EXPECT_NE(error.find(std::string(first) + ", " + second), std::string::npos) << error;
        EXPECT_EQ(error.find("AO"), std::string::npos) << error;
        EXPECT_NE(error.find(std::string("R=") + first + ".R"), std::string::npos) << error;
    }
}

TEST(Layers, WhatWasChosenAmongSeveralIsRemarkedOn) {
    EXPECT_NE(of_layers({"AO", "Combined"}).remark.find("of the layers AO, Combined, Combined is read"),
              std::string::npos);
    EXPECT_EQ(of_layers({"sky"}).remark, "");
    EXPECT_EQ(of_layers({"AO", ""}).remark, "");
}

TEST(Layers, ChannelsAreSpelledInManyWays) {
    for (const Names& names : {Names{"R", "G", "B"},
                               {".R", ".G", ".B"},
                               {"r", "g", "b"},
                               {"red", "green", "blue"},
                               {"beauty.red", "beauty.green", "beauty.blue"},
                               {"beauty_R", "beauty_G", "beauty_B"},
                               {"beauty:R", "beauty:G", "beauty:B"},
                               {"Beauty.r", "beauty.G", "BEAUTY.b"}}) {
        const Choice choice = of_channels(names);
        EXPECT_EQ(choice.error, "") << names[0];
        EXPECT_TRUE(choice.channels.in_order()) << names[0];
    }
    const Choice reversed = of_channels({"A", ".B", ".G", ".R", "Z"});
    EXPECT_EQ(reversed.channels.index[0], 3);
    EXPECT_EQ(reversed.channels.index[2], 1);
}

TEST(Layers, LuminanceAndSingleChannelsAreGrey) {
    for (const Names& names : {Names{"Y"},
                               {"A", "Y"},
                               {"Y", "RY", "BY"},
                               {"Y", "Z"},
                               {"Z", "V"},
                               {"beauty.Y"},
                               {"AO.R", "AO.G", "AO.B", "Y"},
                               {"A", "I", "Depth.V"}}) {
        const Choice choice = of_channels(names);
        EXPECT_EQ(choice.error, "") << names[0];
        EXPECT_TRUE(choice.channels.grey()) << names[0];
    }
    EXPECT_EQ(of_channels({"AO.R", "AO.G", "AO.B", "Y"}).channels.index[0], 3);
    for (const Names& names : {Names{"Z"}, {"A"}, {"N.X", "N.Y", "N.Z"}, {"X", "Y", "Z"}, {"V", "W"}, {"AO.V"}})
        EXPECT_NE(of_channels(names).error, "") << names[0];
    const Choice xyz = choose_layer({{0, "", {"X", "Y", "Z"}, true}});
    EXPECT_EQ(xyz.error, "");
    EXPECT_TRUE(xyz.channels.in_order());
}

TEST(Layers, PartsAreLayersAsWell) {
    const Names rgb = {"R", "G", "B"};
    const Choice named = choose_layer({{0, "AO", rgb}, {1, "depth", {"Z"}}, {2, "rgba", rgb}});
    EXPECT_EQ(named.part, 2);
    EXPECT_NE(named.remark.find("AO, rgba, rgba is read"), std::string::npos) << named.remark;
    const Choice twice = choose_layer(
        {{0, "ViewLayer.AO", rgb_of({"ViewLayer.AO"})}, {1, "ViewLayer.Combined", rgb_of({"ViewLayer.Combined"})}});
    EXPECT_EQ(twice.part, 1);
    const std::string error = choose_layer({{0, "one", rgb}, {1, "two", rgb}}).error;
    EXPECT_NE(error.find("one, two"), std::string::npos) << error;
    EXPECT_NE(error.find("--subimage 0"), std::string::npos) << error;
    // A part on its own is the picture, whatever it is called.
    EXPECT_EQ(choose_layer({{0, "AO", rgb}}).error, "");
}

void write_parts(const std::string& path, const std::vector<OIIO::ImageSpec>& specs) {
    const auto out = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(out->open(path, static_cast<int>(specs.size()), specs.data())) << out->geterror();
    for (std::size_t i = 0; i < specs.size(); ++i) {
        if (i > 0) {
            ASSERT_TRUE(out->open(path, specs[i], OIIO::ImageOutput::AppendSubimage));
        }
        std::vector<float> pixels(static_cast<std::size_t>(specs[i].width * specs[i].height * specs[i].nchannels));
        for (std::size_t k = 0; k < pixels.size(); ++k)
            pixels[k] = static_cast<float>(i + 1) + 0.125f * static_cast<float>(k % 7);
        ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
    }
    ASSERT_TRUE(out->close());
}

OIIO::ImageSpec part(const char* name, const Names& channels) {
    OIIO::ImageSpec spec(16, 8, static_cast<int>(channels.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = channels;
    spec.attribute("oiio:subimagename", name);
    return spec;
}

TEST(Layers, ThePartOfTheLightIsRead) {
    const Folder folder;
    const Names rgb = {"R", "G", "B"};
    write_parts(folder / "a.exr", {part("N", {"N.X", "N.Y", "N.Z"}), part("AO", rgb), part("beauty", rgb)});
    const Probe probe = read_probe(folder / "a.exr");
    EXPECT_EQ(probe.rgb[0], 3.0f);
    EXPECT_EQ(probe.rgb[3], 3.375f);
    ASSERT_EQ(probe.warnings.size(), 1u);
    EXPECT_CONTAINS(probe.warnings[0], "beauty is read");
    write_parts(folder / "b.exr", {part("left", rgb), part("right", rgb)});
    EXPECT_CONTAINS(refusal(folder / "b.exr"), "left, right may be the light");
    write_parts(folder / "c.exr", {part("N", {"N.X", "N.Y", "N.Z"}), part("P", rgb)});
    EXPECT_CONTAINS(refusal(folder / "c.exr"), "where R, G, B or a single one is needed");
}

// A layer that nobody chose is reported, unless it is the image itself; of two that are as good none is.
TEST(Layers, OfAFileAreReported) {
    const Folder folder;
    OIIO::ImageSpec spec(8, 4, 6, OIIO::TypeDesc::FLOAT);
    std::vector<float> pixels;
    for (int i = 0; i < 32; ++i) pixels.insert(pixels.end(), {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f});
    const std::string path = folder / "layers.exr";
    const auto write = [&](const std::vector<std::string>& names) {
        spec.channelnames = names;
        write_image(path, spec, pixels);
    };
    write({"diffuse.R", "diffuse.G", "diffuse.B", "gloss.R", "gloss.G", "gloss.B"});
    EXPECT_CONTAINS(refusal(path), "diffuse, gloss may be the light");
    write({"AO.R", "AO.G", "AO.B", "Combined.R", "Combined.G", "Combined.B"});
    const Probe layered = read_probe(path);
    EXPECT_EQ(layered.rgb[0], 4.0f);
    ASSERT_EQ(layered.warnings.size(), 1u);
    EXPECT_CONTAINS(layered.warnings[0], "of the layers AO, Combined, Combined is read");
    write({"diffuse.R", "diffuse.G", "diffuse.B", "R", "G", "B"});
    const Probe plain = read_probe(path);
    EXPECT_EQ(plain.rgb[0], 4.0f) << "R, G and B come before a layer, wherever they stand";
    EXPECT_TRUE(plain.warnings.empty());
}

} // namespace
