// Scenes as JSON, and samplers as text.
#include "tests/tools/render/scenes.h"
#include "tools/render/output_files.h"
#include "tools/render/sampler_spec.h"

#include <acdf/builder.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <filesystem>

namespace acdf::tools {
namespace {

using Json = nlohmann::json;

std::string scene_error(const std::string& text) {
    try {
        parse_scene(text);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

Json small() { return Json::parse(test::small_scene("\"full-cdf\", \"cosine\"")); }

TEST(RenderSceneFile, IsReadWhole) {
    const SceneFile scene = parse_scene(small().dump());
    EXPECT_EQ(scene.camera.from, (measure::Vec3{4.0, -1.0, 2.0}));
    EXPECT_EQ(scene.camera.up, (measure::Vec3{0.0, 0.0, 1.0}));
    EXPECT_EQ(scene.camera.fov, 35.0);
    EXPECT_EQ(scene.width, 8u);
    EXPECT_EQ(scene.height, 6u);
    EXPECT_EQ(scene.probe, "probe.pfm");
    EXPECT_EQ(scene.reading.projection, input::Projection::latlong);
    EXPECT_EQ(scene.samples, 8u);
    EXPECT_EQ(scene.samplers, (std::vector<std::string>{"full-cdf", "cosine"}));
    ASSERT_EQ(scene.geometry.objects.size(), 3u);
    EXPECT_EQ(std::get<measure::Sphere>(scene.geometry.objects[1].shape).radius, 1.0);
    EXPECT_EQ(std::get<measure::Box3>(scene.geometry.objects[2].shape).high[2], 4.0);
    EXPECT_FALSE(scene.geometry.objects[2].seen);
    ASSERT_EQ(scene.materials.size(), 2u); // what is not seen reflects nothing
    EXPECT_EQ(scene.materials[scene.geometry.objects[1].material].tint[1], 0.7);
}

TEST(RenderSceneFile, TakesEverySourceOfTheCommandLine) {
    Json json = small();
    json["light"] = {{"probe", {"a", "b", "c", "d", "e", "f"}},
                     {"projection", "cube-cross"},
                     {"faces", "opengl"},
                     {"bad_pixels", "clamp"}};
    const SceneFile scene = parse_scene(json.dump());
    EXPECT_EQ(scene.probe, "a,b,c,d,e,f");
    EXPECT_EQ(scene.reading.projection, input::Projection::cube_cross);
    ASSERT_TRUE(scene.reading.faces);
    EXPECT_EQ(scene.reading.faces->frame, input::Faces::Frame::opengl);
    EXPECT_EQ(scene.reading.bad_pixels, build::BadPixels::clamp);
}

TEST(RenderSceneFile, EqualMaterialsAreOne) {
    Json json = small();
    json["objects"].push_back(json["objects"][1]);
    EXPECT_EQ(parse_scene(json.dump()).materials.size(), 2u);
    json["objects"][3]["tint"] = {0.1, 0.1, 0.1};
    EXPECT_EQ(parse_scene(json.dump()).materials.size(), 3u);
}

/// What is changed, where to and which words the error must have.
struct Mistake {
    const char* pointer;
    Json value;
    const char* says;
};

TEST(RenderSceneFile, MistakesAreNamedWithTheirKey) {
    const std::vector<Mistake> mistakes{
        {"/camera/fov", 171, "camera.fov: is 171, not from 0.01 to 170"},
        {"/camera/fov", "wide", "camera.fov: is string, not a number"},
        {"/camera/from", {1, 2}, "camera.from: is not an array of three numbers"},
        {"/camera/from", {0, 0, 0.7}, "camera: has no direction"},
        {"/camera/from",
         {0, 0, 5},
         "camera: has no direction: 'from' equals 'to', or 'up' is parallel to the view"},
        {"/camera/from/1", 1e7, "camera.from[1]: is 1e+07, not from"},
        {"/camera/speed", 1, "camera: has an unknown key 'speed'"},
        {"/image/width", 0, "image.width: is 0, not from 1 to 4096"},
        {"/image/width", 1.5, "image.width: is 1.5, not a whole number"},
        {"/light/built_in", "sky", "light: needs one of 'probe' and 'built_in'"},
        {"/light/projection", "flat", "light.projection: is not a projection"},
        {"/light/faces", "vulkan", "light.faces: is not an order of faces"},
        {"/light/bad_pixels", "keep", "light.bad_pixels: is none of zero, clamp, error"},
        {"/light/probe", {"a", "b"}, "light.probe: is not one file, or six"},
        {"/light/probe", {"a", "b", "c", "d", "e", "f,g"}, "light.probe: has a face with a comma"},
        {"/light/filter", "cubic", "light.filter: is not a filter: nearest, bilinear"},
        {"/light/probe", "", "light.probe: is empty"},
        {"/light/probe", "a\nb", "light.probe: has control characters"},
        {"/objects", Json::array(), "objects: is empty"},
        {"/objects", 7, "objects: is number, not an array"},
        {"/objects/1/sphere/radius", 0, "objects[1].sphere.radius: is 0"},
        {"/objects/1/box", Json::parse(R"({"low": [0, 0, 0], "high": [1, 1, 1]})"),
         "objects[1]: needs one of 'sphere', 'plane', 'box' and 'mesh'"},
        {"/objects/1/brdf", 3, "objects[1].brdf: is number, not a string"},
        {"/objects/1/tint", {0, 2, 0}, "objects[1].tint[1]: is 2"},
        {"/objects/2/box/low", {9, 0, 0}, "objects[2].box: 'low' is not below 'high' on every axis"},
        {"/objects/2/seen", 0, "objects[2].seen: is number, not true or false"},
        {"/objects/2/seen", true, "objects[2]: lacks 'brdf'"},
        {"/portals", Json::array(), "portals: is empty"},
        {"/portals/0", Json::parse(R"({"corner": [0, 0, 0], "across": [1, 0, 0], "up": [1, 1, 0]})"),
         "portals[0]: is not a rectangle"},
        {"/portals/0", Json::parse(R"({"corner": [0, 0, 0], "across": [0, 0, 0], "up": [1, 1, 0]})"),
         "portals[0]: has no area"},
        {"/portals/0", Json::parse(R"({"corner": [0, 0, 0], "across": [1, 0, 0]})"), "portals[0]: lacks 'up'"},
        {"/samples", -1, "samples: is -1"},
        {"/seeds", 2, "seeds: is below 3"},
        {"/reference", 0, "reference: is number, not true or false"},
        {"/samplers", Json::array(), "samplers: is empty"},
        {"/samplers/0", false, "samplers[0]: is boolean, not a string"},
        {"/colour", "red", "the scene: has an unknown key 'colour'"},
    };
    for (const Mistake& mistake : mistakes) {
        Json json = small();
        json[Json::json_pointer(mistake.pointer)] = mistake.value;
        const std::string error = scene_error(json.dump());
        EXPECT_NE(error.find(mistake.says), std::string::npos) << mistake.pointer << ": " << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
    for (const char* key : {"camera", "light", "objects", "samples", "samplers"}) {
        Json json = small();
        json.erase(key);
        EXPECT_EQ(scene_error(json.dump()), std::string("the scene: lacks '") + key + "'");
    }
    Json unseen = small();
    const Json last = unseen["objects"][2];
    unseen["objects"] = Json::array();
    unseen["objects"].push_back(last);
    EXPECT_EQ(scene_error(unseen.dump()), "objects: has no object that the camera sees");
}

TEST(RenderSceneFile, OnlyStrictJson) {
    EXPECT_NE(scene_error("").find("not JSON"), std::string::npos);
    EXPECT_NE(scene_error("{\"camera\": }").find("line 1, column 12"), std::string::npos);
    EXPECT_EQ(scene_error("[]"), "the scene: is array, not an object");
    EXPECT_EQ(scene_error(R"({"samples": 1, "samples": 2})"), "the key 'samples' is given twice");
    EXPECT_NE(scene_error(R"({"a": {"x": 1}, "b": {"x": 1}})").find("lacks 'camera'"), std::string::npos);
    EXPECT_NE(scene_error("{\"a\": NaN}").find("not JSON"), std::string::npos);
    EXPECT_NE(scene_error(std::string(100000, '[')).find("not JSON"), std::string::npos);
    EXPECT_NE(scene_error("{\"\xff\": 1}").find("not JSON"), std::string::npos);
}

TEST(RenderSceneFile, CommittedScenesAreRead) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(ACDF_SCENES)) {
        ++count;
        const SceneFile scene = parse_scene(test::read_text(entry.path()));
        EXPECT_FALSE(scene.description.empty()) << entry.path();
        for (const std::string& text : scene.samplers) EXPECT_NO_THROW(parse_sampler(text)) << text;
    }
    EXPECT_GE(count, 10);
}

std::string spec_error(const std::string& text) {
    try {
        parse_sampler(text);
    } catch (const SpecError& error) {
        return error.what();
    }
    return "";
}

TEST(RenderSampler, TextsAreUnderstood) {
    EXPECT_EQ(parse_sampler("full-cdf").kind, SamplerKind::full_cdf);
    EXPECT_EQ(parse_sampler("local:1MB").bytes, 1000000u);
    EXPECT_EQ(parse_sampler("env").bytes, builder::DefaultBudget::environment);
    EXPECT_EQ(parse_sampler("local").bytes, builder::DefaultBudget::local);
    EXPECT_EQ(parse_sampler("visibility").bytes, builder::DefaultBudget::visibility);
    EXPECT_EQ(parse_sampler("brdf").bytes, builder::DefaultBudget::brdf);
    EXPECT_EQ(parse_sampler("tiles:64x32").columns, 64u);
    EXPECT_EQ(parse_sampler("tiles").rows, 16u);
    EXPECT_EQ(parse_sampler("visibility-cache:8x4").columns, 8u);
    EXPECT_EQ(parse_sampler("learned:2MB --mis cosine").mis.kind, ACDF_PARTNER_COSINE); // valid alone, too
    EXPECT_FALSE(parse_sampler("portals").uniform);
    EXPECT_TRUE(parse_sampler("portals:uniform").uniform);
    EXPECT_EQ(parse_sampler("ris:8").candidates, 8u);
    EXPECT_EQ(parse_sampler("ggx:0.25").alpha, 0.25);
    EXPECT_TRUE(parse_sampler("brdf-table:centre").centre);
    EXPECT_FALSE(parse_sampler("brdf-table").centre);
    EXPECT_TRUE(parse_sampler("strata:radiance").by_radiance);
    EXPECT_EQ(parse_sampler("file:a b:c.acdf").path, "a b:c.acdf");

    const SamplerSpec mis = parse_sampler("mis-power(4*local:1MB,cosine)");
    EXPECT_EQ(mis.kind, SamplerKind::mis);
    EXPECT_TRUE(mis.power);
    ASSERT_EQ(mis.parts.size(), 2u);
    EXPECT_EQ(mis.parts[0].text, "local:1MB");
    EXPECT_DOUBLE_EQ(mis.shares[0], 0.8);
    EXPECT_EQ(divided(20, mis), (std::vector<std::uint32_t>{16, 4}));
    EXPECT_EQ(divided(2, mis), (std::vector<std::uint32_t>{1, 1}));
    EXPECT_EQ(divided(7, parse_sampler("mis(cosine,full-cdf,env)")), (std::vector<std::uint32_t>{3, 2, 2}));
    EXPECT_EQ(divided(3, parse_sampler("mis(1000*cosine,full-cdf,env)")), (std::vector<std::uint32_t>{1, 1, 1}));
    EXPECT_THROW(divided(1, mis), SpecError);

    const SamplerSpec product = parse_sampler("product:32(local:1MB,ggx:0.1)");
    EXPECT_EQ(product.kind, SamplerKind::product);
    EXPECT_EQ(product.divisions, 32u);
    ASSERT_EQ(product.parts.size(), 2u);
    EXPECT_EQ(product.parts[0].bytes, 1000000u);
    EXPECT_EQ(product.parts[1].alpha, 0.1);
    EXPECT_EQ(parse_sampler("product(env,file:a.acdf)").divisions, 0u); // as the samples ask for
    EXPECT_EQ(parse_sampler("mis(warp(local,brdf),brdf)").parts[0].kind, SamplerKind::warp);
    EXPECT_EQ(parse_sampler("ris:8(local,brdf)").candidates, 8u);
    EXPECT_EQ(parse_sampler("tiles:12x12(brdf)").parts[0].kind, SamplerKind::brdf);
    EXPECT_EQ(parse_sampler("file:a(1)").path, "a(1)");
    EXPECT_EQ(parse_sampler("mis(tiles:12x12(brdf),3*product(local,brdf))").parts[1].parts.size(), 2u);

    const SamplerSpec with =
        parse_sampler("mis(2*auto:local:1MB --mis cosine --shares 3:1 --heuristic power --scene, cosine)");
    EXPECT_TRUE(with.parts[0].automatic && with.parts[0].of_scene);
    EXPECT_EQ(with.parts[0].mis.kind, ACDF_PARTNER_COSINE);
    EXPECT_EQ(with.parts[0].mis.heuristic, ACDF_HEURISTIC_POWER);
    EXPECT_EQ(with.parts[0].mis.light, 3.0);
    EXPECT_EQ(with.parts[1].kind, SamplerKind::cosine);
    for (const char* text :
         {"local:1MB --mis cosine", "mis(local --mis mean,cosine)", "mis(full-cdf --scene,cosine)",
          "mis(env --mis,cosine)", "mis(env --mis sun,cosine)", "mis(env --shares 2,cosine)",
          "mis(auto:env --mis cosine,auto:cosine)", "mis(ideal --mis brdf,cosine)", "mis(local --mis brdf,cosine)",
          "mis(learned --mis brdf,cosine)", "mis(learned --mis cosine --shares 2:1,cosine)"})
        EXPECT_THROW(parse_sampler(text), SpecError) << text;
    const SamplerSpec compensated = parse_sampler("mis-compensated");
    EXPECT_EQ(compensated.text, "mis-compensated");
    ASSERT_EQ(compensated.parts.size(), 2u);
    EXPECT_EQ(compensated.parts[0].kind, SamplerKind::compensated);
}

TEST(RenderSampler, MistakesAreNamed) {
    const std::pair<const char*, const char*> mistakes[] = {
        {"", "is none of full-cdf"},
        {"nonsense", "is none of full-cdf"},
        {"local:big", "'big' is not a size"},
        {"local:", "'' is not a size"},
        {"cosine:1", "takes no argument"},
        {"tiles:32", "is not a grid"},
        {"visibility-cache:32", "is not a grid"},
        {"portals:x", "give portals or portals:uniform"},
        {"ris:0", "the number of candidates is"},
        {"product", "give product(LIGHT,BRDF)"},
        {"local:1MB --slow", "is not an option"},
        {"product:0(local,brdf)", "the number of parts is"},
        {"product:97(local,brdf)", "the number of parts is"},
        {"product(local)", "give product(LIGHT,BRDF)"},
        {"warp", "give warp(LIGHT,BRDF)"},
        {"warp(brdf,local)", "give warp(LIGHT,BRDF)"},
        {"product(brdf,local)", "give product(LIGHT,BRDF)"},
        {"product(local,product(local,brdf))", "is none of"},
        {"ris:8(local)", "from two samplers"},
        {"tiles:12x12(local)", "give tiles:12x12(BRDF)"},
        {"cosine(local)", "takes no samplers in parentheses"},
        {"ris:1.5", "the number of candidates is"},
        {"ggx:nan", "alpha is a number"},
        {"ggx: 0.1", "alpha is a number"},
        {"file:", "needs a file"},
        {"strata:x", "give strata or"},
        {"brdf-table:x", "give brdf-table:mean"},
        {"compensated", "pdf is 0 where"},
        {"mis(cosine)", "combines from 2"},
        {"mis(cosine,)", "is none of"},
        {"mis(cosine,ris:4)", "has no pdf, which MIS needs"},
        {"mis(cosine,strata)", "has no pdf, which MIS needs"},
        {"mis(0*cosine,env)", "shares are"},
        {"mis(cosine,env", "is none of"},
        {"mis(cosine,env))", "a ')' too many"},
    };
    for (const auto& [text, says] : mistakes)
        EXPECT_NE(spec_error(text).find(says), std::string::npos) << text << ": " << spec_error(text);
    EXPECT_NE(spec_error(std::string(5000, 'a')), "");
}

TEST(RenderSampler, FileNamesArePlain) {
    EXPECT_EQ(file_stem(parse_sampler("mis(4*local:1MB,cosine)")), "mis-4-local-1MB-cosine");
    EXPECT_EQ(file_stem(parse_sampler("file:../a/b.acdf")), "file-__-a-b_acdf");
}

TEST(RenderSampler, NoTwoFilesHaveTheSameName) {
    std::vector<SamplerSpec> samplers;
    for (const char* text :
         {"cosine", "cosine", "file:a", "file:a-variance", "file:a.above", "file:b-gain", "file:b"})
        samplers.push_back(parse_sampler(text));
    EXPECT_EQ(file_stems(samplers), (std::vector<std::string>{"cosine", "cosine-2", "file-a", "file-a-variance-2",
                                                              "file-a_above", "file-b-gain", "file-b-2"}));
}

} // namespace
} // namespace acdf::tools
