// What files are that are none of ours.
#include "rules/signatures.h"

#include <gtest/gtest.h>

#include <string>

namespace {

TEST(Signatures, nameOtherFormats) {
    const auto message_of = [](std::string start, std::size_t size = 1000) {
        start.resize(size);
        return std::string(acdf::what_is_it(reinterpret_cast<const std::uint8_t*>(start.data()), start.size()));
    };
    using namespace std::string_literals;
    const auto expect = [](const std::string& message, const char* word) {
        EXPECT_NE(message.find(word), std::string::npos) << message;
    };
    expect(message_of("\x76\x2f\x31\x01"), "OpenEXR");
    expect(message_of("#?RADIANCE\n"), "Radiance HDR");
    expect(message_of("#?RGBE\n"), "Radiance HDR");
    expect(message_of("\x89PNG\r\n\x1a\n"), "PNG");
    expect(message_of("\x93NUMPY"), "NumPy");
    expect(message_of("II*\0"s), "TIFF");
    expect(message_of("MM\0*"s), "TIFF");
    expect(message_of("tensor_file\0"s), "RGL");
    expect(message_of("\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0"s, 12 + 3 * 8 * 90 * 90 * 180), "MERL");
    expect(message_of("\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0"s), "not an .acdf file");
    expect(message_of("\xab"
                      "ACDF  \xbb\n\x1a\n"),
           "CR LF into LF");
    expect(message_of("\xab"
                      "ACDF  \xbb\r\r\n\x1a\r\n"),
           "LF into CR LF");
    expect(message_of("+ACDF  ;\r\n\x1a\n"), "highest bit");
    expect(message_of("\xab"
                      "ACDF\0"s),
           "damaged");
    expect(message_of("hello"), "not an .acdf file");
    EXPECT_STREQ(acdf::what_is_it(reinterpret_cast<const std::uint8_t*>("PN"), 2), "this is not an .acdf file");
}

TEST(Signatures, nameWhatIsSentOrConvertedInPlaceOfAFile) {
    const auto what = [](const std::string& content) {
        return std::string(acdf::what_is_it(reinterpret_cast<const std::uint8_t*>(content.data()), content.size()));
    };
    const auto expect = [&](const std::string& content, const char* name) {
        EXPECT_NE(what(content).find(name), std::string::npos) << what(content);
    };
    expect("version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n", "this is a Git LFS pointer");
    expect("/annex/objects/SHA256E-s1--00.acdf\n", "this is a git-annex pointer");
    for (const char* page :
         {"<!DOCTYPE html><html>", "<!doctype html>", "<html>", "<HTML>", "<?xml version=\"1.0\"?>"})
        expect(page, "this is a web page");
    expect("\xab"
           "ACDF  \xbb\r\n\x1a\r\n",
           "Git turned LF into CR LF");
    expect("\xab"
           "ACDF  \xbb\r\r\n\x1a\r\n",
           "turned LF into CR LF");
    expect("\xab"
           "ACDF  \xbb\n\x1a\n",
           "turned CR LF into LF");
}

} // namespace
