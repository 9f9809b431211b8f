// Reading .npy files: every accepted form, and one clear line for everything else.
#include "tests/inputs/sanitized.h"
#include "tests/inputs/table_files.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cstdio>
#include <limits>
#include <memory>

namespace {

using namespace acdf;
using namespace acdf::test;
using input::BadValuePolicy;
using input::NpyArray;

NpyArray read(const std::string& bytes, BadValuePolicy policy = BadValuePolicy::refuse) {
    std::string copy = bytes + '\0'; // fmemopen refuses to open nothing
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(fmemopen(copy.data(), copy.size(), "rb"),
                                                               &std::fclose);
    return input::read_npy(file.get(), bytes.size(), "a.npy", {policy});
}

// The one line with which a file is refused.
std::string refusal(const std::string& bytes, BadValuePolicy policy = BadValuePolicy::refuse) {
    try {
        read(bytes, policy);
    } catch (const input::Error& error) {
        const std::string text = error.what();
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        EXPECT_EQ(text.rfind("a.npy: ", 0), 0u) << text;
        return text;
    }
    ADD_FAILURE() << "it was read";
    return {};
}

#define EXPECT_CONTAINS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

const std::vector<float> six{1, 2, 3, 4, 5, 6};

TEST(Npy, FilesByTheirPath) {
    const Folder folder;
    write_text(folder / "a.npy", npy_file(six, {2, 3}));
    EXPECT_EQ(input::read_npy(folder / "a.npy").values, six);
    write_text(folder / "a.npy", npy_file(six, {2, 4}));
    EXPECT_THROW(input::read_npy(folder / "a.npy"), input::Error);
}

TEST(Npy, FloatsInRowMajorOrder) {
    const NpyArray a = read(npy_file(six, {2, 3}));
    EXPECT_EQ(a.shape, (ShapeVector{2, 3}));
    EXPECT_EQ(a.values, six);
    EXPECT_EQ(a.scale, 1.0);
    EXPECT_EQ(a.bad.count(), 0u);
}

TEST(Npy, EveryVersionAndWordOrder) {
    for (int major : {1, 2, 3}) EXPECT_EQ(read(npy_file(six, {6}, false, major)).values, six);
    for (const char* descr : {"<f4", "=f4", "|f4"})
        EXPECT_EQ(read(npy_file(npy_dict(descr, false, {3, 2}), raw_bytes(six))).values, six);
    EXPECT_EQ(read(npy_file("{\"shape\":(6,),\"fortran_order\":False,\"descr\":\"<f4\"}", raw_bytes(six))).values,
              six);
    EXPECT_EQ(
        read(npy_file("{ 'shape' : ( 2 , 3 ) , 'descr':'<f4','fortran_order' :False }", raw_bytes(six))).values,
        six);
}

TEST(Npy, Doubles) {
    const NpyArray a = read(npy_file(std::vector<double>{0.5, 0.1, -0.0}, {3}));
    EXPECT_EQ(a.values, (std::vector<float>{0.5f, 0.1f, 0.0f}));
    EXPECT_FALSE(std::signbit(a.values[2]));
    EXPECT_EQ(a.scale, 1.0);
}

TEST(Npy, FortranOrder) {
    // Column by column of [[1, 2, 3], [4, 5, 6]].
    EXPECT_EQ(read(npy_file(std::vector<float>{1, 4, 2, 5, 3, 6}, {2, 3}, true)).values, six);
    // All of six axes of different lengths: the first one fastest.
    const ShapeVector shape{2, 3, 1, 4, 2, 5};
    std::vector<double> in_file;
    ShapeVector index(6, 0);
    for (std::size_t i = 0; i < count_of(shape); ++i) {
        double value = 0.0;
        for (const std::uint32_t k : index) value = 10.0 * value + k;
        in_file.push_back(value);
        for (std::size_t axis = 0; axis < 6 && ++index[axis] == shape[axis]; ++axis) index[axis] = 0;
    }
    const NpyArray expected = array_of(shape, [](const ShapeVector& at) {
        double value = 0.0;
        for (const std::uint32_t k : at) value = 10.0 * value + k;
        return value;
    });
    EXPECT_EQ(read(npy_file(in_file, shape, true)).values, expected.values);
}

TEST(Npy, LargerThanOneBlock) {
    std::vector<float> values(200001);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 1009);
    EXPECT_EQ(read(npy_file(values, {200001})).values, values);
}

TEST(Npy, DoublesBeyondFloatAreScaled) {
    const std::vector<double> huge{1e300, 1e290, 0.0, 1e-300};
    const NpyArray a = read(npy_file(huge, {4}));
    EXPECT_NE(a.scale, 1.0);
    int exponent = 0;
    EXPECT_EQ(std::frexp(a.scale, &exponent), 0.5) << "not a power of two";
    EXPECT_NEAR(a.values[0] * a.scale / huge[0], 1.0, 1e-7);
    EXPECT_NEAR(a.values[1] * a.scale / huge[1], 1.0, 1e-7);
    EXPECT_EQ(a.values[2], 0.0f);
    EXPECT_GT(a.values[3], 0.0f) << "what is positive stays so: else nothing would be sampled there";
    EXPECT_LT(a.values[0], std::numeric_limits<float>::infinity());

    const NpyArray small = read(npy_file(std::vector<double>{1e-310, 3e-310}, {2}));
    EXPECT_GT(small.values[0], FLT_MIN);
    EXPECT_NEAR(small.values[1] / small.values[0], 3.0f, 1e-5);
    EXPECT_NEAR(small.values[1] * small.scale / 3e-310, 1.0, 1e-6);

    const NpyArray edge = read(npy_file(std::vector<double>{1.7976931348623157e308, 1.0}, {2}));
    EXPECT_TRUE(std::isfinite(edge.values[0]));
}

TEST(Npy, BadValues) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const std::vector<float> values{1, 2, 3, -4, nan, 6, inf, -inf};
    const std::string text = refusal(npy_file(values, {2, 2, 2}));
    EXPECT_CONTAINS(text, "1 NaN, 2 infinite, 1 negative");
    EXPECT_CONTAINS(text, "[0, 1, 1]");
    EXPECT_CONTAINS(text, "--bad-values zero");
    const NpyArray a = read(npy_file(values, {2, 2, 2}), BadValuePolicy::zero);
    EXPECT_EQ(a.values, (std::vector<float>{1, 2, 3, 0, 0, 6, 0, 0}));
    EXPECT_EQ(a.bad.nan, 1u);
    EXPECT_EQ(a.bad.infinite, 2u);
    EXPECT_EQ(a.bad.negative, 1u);
    EXPECT_EQ(a.bad.first, 3u);
    // In Fortran order the first is the first of the array, not of the file.
    EXPECT_CONTAINS(refusal(npy_file(std::vector<float>{1, 2, -1, 3, -1, 3}, {3, 2}, true)), "[1, 1]");
    EXPECT_CONTAINS(refusal(npy_file(std::vector<double>{1, -1e-320}, {2})), "1 negative");
}

TEST(Npy, OtherTypesAreRefusedWithAdvice) {
    const auto with = [](const std::string& descr) {
        return refusal(
            npy_file("{'descr': " + descr + ", 'fortran_order': False, 'shape': (2,), }", std::string(16, '\0')));
    };
    EXPECT_CONTAINS(with("'>f4'"), "big-endian");
    EXPECT_CONTAINS(with("'>f8'"), "astype('<f8')");
    for (const char* descr :
         {"'<i4'", "'|u1'", "'<f2'", "'<c8'", "'|b1'", "'<f16'", "'<U3'", "'|O'", "''", "'<'", "'f'"})
        EXPECT_CONTAINS(with(descr), "astype('<f4')");
    EXPECT_CONTAINS(with("[('a', '<f4'), ('b', '<f4')]"), "structured dtype");
}

TEST(Npy, OtherShapesAreRefused) {
    const auto with = [](const std::string& shape) {
        return refusal(
            npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': " + shape + ", }", std::string(64, '\0')));
    };
    EXPECT_CONTAINS(with("()"), "single number");
    EXPECT_CONTAINS(with("(0,)"), "empty");
    EXPECT_CONTAINS(with("(3, 0, 2)"), "empty");
    EXPECT_CONTAINS(with("(1, 1, 1, 1, 1, 1, 1)"), "7 axes");
    EXPECT_CONTAINS(with("(4294967296,)"), "2^34");
    EXPECT_CONTAINS(with("(2147483647, 2147483647, 2147483647)"), "2^34");
    EXPECT_CONTAINS(with("(99999999999999999999,)"), "digits");
    EXPECT_CONTAINS(with("(1048576, 4096)"), "cut short"); // refused before 16 GiB are asked for
}

TEST(Npy, DamagedHeaders) {
    for (const char* dict : {"",
                             "{",
                             "}",
                             "{}",
                             "[]",
                             "{'descr': '<f4'}",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (1,)",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (1,), } x",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (1,), 'more': 1}",
                             "{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, 'shape': (1,)}",
                             "{'descr': '<f4', 'fortran_order': 0, 'shape': (1,)}",
                             "{'descr': '<f4', 'fortran_order': false, 'shape': (1,)}",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': 1}",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (1)}",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (1 1)}",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (-1,)}",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (01,)}",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (1,,)}",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (1L,)}",
                             "{'descr': '<f4' 'fortran_order': False, 'shape': (1,)}",
                             "{'descr': '\\x3cf4', 'fortran_order': False, 'shape': (1,)}",
                             "{\x01}"})
        EXPECT_CONTAINS(refusal(npy_file(dict, raw_bytes(std::vector<float>{1}))), "damaged") << dict;
}

TEST(Npy, OtherFiles) {
    EXPECT_CONTAINS(refusal(""), "not an .npy file");
    EXPECT_CONTAINS(refusal("1,2,3\n"), "not an .npy file");
    EXPECT_CONTAINS(refusal("PK\x03\x04 and so on"), "archive");
    std::string version = npy_file(six, {6});
    version[6] = 4;
    EXPECT_CONTAINS(refusal(version), "version 4.0");
    version[6] = 1, version[7] = 1;
    EXPECT_CONTAINS(refusal(version), "version 1.1");
    std::string huge = npy_file(six, {6}, false, 2);
    huge[10] = 1; // 65536 bytes and more
    EXPECT_CONTAINS(refusal(huge), "its header claims");
    const Folder folder;
    EXPECT_THROW(input::read_npy(folder / "missing.npy"), input::Error);
    EXPECT_THROW(input::read_npy(folder / ""), input::Error);
    EXPECT_THROW(input::read_npy("/dev/null"), input::Error);
}

TEST(Npy, EveryLengthButTheRightOne) {
    for (int major : {1, 2}) {
        const std::string whole = npy_file(six, {2, 3}, false, major);
        for (std::size_t length = 0; length < whole.size(); ++length)
            EXPECT_NE(refusal(whole.substr(0, length)), "") << length;
        EXPECT_CONTAINS(refusal(whole.substr(0, whole.size() - 1)), "cut short");
        EXPECT_CONTAINS(refusal(whole + '\0'), "1 bytes follow");
    }
}

// Every damaged file is read or refused in one line.
TEST(Npy, FlippedBytes) {
    std::mt19937 random(5);
    const std::string good = npy_file(six, {2, 3});
    const int times = acdf_test::repeated(20000); // what is refused takes sanitizers long
    int refused = 0;
    for (int i = 0; i < times; ++i) {
        std::string bytes = good;
        bytes[random() % bytes.size()] = static_cast<char>(random());
        try {
            const NpyArray a = read(bytes, BadValuePolicy::zero);
            ASSERT_EQ(a.values.size(), count_of(a.shape));
        } catch (const input::Error& error) {
            ++refused;
            ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
    EXPECT_GT(refused, times / 4);
}

TEST(Npy, IndexText) {
    EXPECT_EQ(input::index_text({5}, 3), "3");
    EXPECT_EQ(input::index_text({2, 3, 4}, 23), "1, 2, 3");
    EXPECT_EQ(input::index_text({2, 3, 4}, 0), "0, 0, 0");
}

} // namespace
