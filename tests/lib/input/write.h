// Image files for the tests, written by OpenImageIO.
#pragma once

#include "input/probe/probe.h"
#include "tests/inputs/folder.h"
#include "tests/lib/build/probe/projection_reference.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <memory>

namespace acdf::test {

// Writes float pixels, `spec.nchannels` each, as `spec` says.
inline void write_image(const std::string& path, const OIIO::ImageSpec& spec, const std::vector<float>& pixels) {
    const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(out) << OIIO::geterror();
    ASSERT_TRUE(out->open(path, spec)) << out->geterror();
    ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, pixels.data())) << out->geterror();
    ASSERT_TRUE(out->close()) << out->geterror();
}

inline OIIO::ImageSpec rgb_spec(const Pixels& pixels, OIIO::TypeDesc type = OIIO::TypeDesc::FLOAT) {
    return OIIO::ImageSpec(pixels.width, pixels.height, 3, type);
}

inline void write_rgb(const std::string& path, const Pixels& pixels, OIIO::TypeDesc type = OIIO::TypeDesc::FLOAT) {
    write_image(path, rgb_spec(pixels, type), pixels.rgb);
}

inline Pixels latlong_sky(int width = 64) { return render_sky(latlong_reference, width, width / 2); }

// The message of the Error that reading `path` throws; "" and a failure where it throws none.
inline std::string refusal(const std::string& path, input::Projection projection = input::Projection::automatic) {
    try {
        input::ProbeOptions options;
        options.projection = projection;
        options.threads = 1;
        input::read_probe(path, options);
    } catch (const input::Error& error) {
        const std::string text = error.what();
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        EXPECT_EQ(text.rfind(path, 0), 0u) << "the file is not named first: " << text;
        return text;
    }
    ADD_FAILURE() << path << " was read";
    return {};
}

} // namespace acdf::test
