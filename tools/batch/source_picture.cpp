#include "tools/batch/source_picture.h"

#include "input/brdf/brdf.h"
#include "tools/plot/brdf.h"
#include "tools/plot/colour.h"
#include "tools/plot/pdf_image.h"
#include "tools/plot/range.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

namespace acdf::tools {
namespace {

/// Means over the pixels of a picture, of rows as they come.
class Shrunk : public input::ProbeRows {
public:
    explicit Shrunk(int width) : out_(width, width / 2) {}

    void begin(int width, int height) override {
        width_ = width;
        height_ = height;
        rows_.assign(static_cast<std::size_t>(height), {});
    }

    void take(int first, int count, const float* rgb) override {
        for (int y = first; y < first + count; ++y, rgb += 3 * static_cast<std::ptrdiff_t>(width_)) shrink(y, rgb);
    }

    /// Of small maps pixels repeat; of large ones each is a mean.
    images::Picture finish() {
        for (int y = 0; y < out_.height; ++y) {
            const int begin = scaled(y, height_, out_.height),
                      end = std::max(begin + 1, scaled(y + 1, height_, out_.height));
            for (int i = 0; i < 3 * out_.width; ++i) {
                double sum = 0.0;
                for (int row = begin; row < end; ++row)
                    sum += double{rows_[static_cast<std::size_t>(row)][static_cast<std::size_t>(i)]};
                out_.at(0, y)[i] = static_cast<float>(sum / (end - begin));
            }
        }
        return std::move(out_);
    }

private:
    static int scaled(int i, int from, int to) {
        return static_cast<int>(static_cast<std::int64_t>(i) * from / to);
    }

    void shrink(int y, const float* rgb) {
        std::vector<float>& row = rows_[static_cast<std::size_t>(y)];
        row.assign(static_cast<std::size_t>(3 * out_.width), 0.0f);
        for (int x = 0; x < out_.width; ++x) {
            const int begin = scaled(x, width_, out_.width),
                      end = std::max(begin + 1, scaled(x + 1, width_, out_.width));
            for (int c = 0; c < 3; ++c) {
                double sum = 0.0;
                for (int column = begin; column < end; ++column) sum += double{rgb[3 * column + c]};
                row[static_cast<std::size_t>(3 * x + c)] = static_cast<float>(sum / (end - begin));
            }
        }
    }

    images::Picture out_;
    int width_ = 0, height_ = 0;
    std::vector<std::vector<float>> rows_; // as wide as the picture; may be replaced
};

/// Nine tenths of the pixels end below white.
void expose(images::Picture& picture) {
    std::vector<float> brightest;
    for (std::size_t i = 0; i < picture.values.size(); i += 3)
        brightest.push_back(*std::max_element(picture.values.begin() + static_cast<std::ptrdiff_t>(i),
                                              picture.values.begin() + static_cast<std::ptrdiff_t>(i + 3)));
    const auto ninth = brightest.begin() + static_cast<std::ptrdiff_t>(brightest.size() * 9 / 10);
    std::nth_element(brightest.begin(), ninth, brightest.end());
    const float most = *std::max_element(ninth, brightest.end()), white = *ninth > 0.0f ? *ninth : most;
    for (float& value : picture.values) value = linear_to_srgb(white > 0.0f ? std::min(1.0f, value / white) : 0.0f);
}

} // namespace

images::Picture probe_picture(const std::string& path, const input::ProbeOptions& options, int width) {
    Shrunk rows(width);
    input::read_probe(path, options, rows);
    images::Picture picture = rows.finish();
    expose(picture);
    return picture;
}

images::Picture brdf_picture(const std::string& source, int width) {
    const std::unique_ptr<input::Brdf> brdf = input::open_brdf(source);
    const double cosine = std::sqrt(0.5), wo[3] = {cosine, 0.0, cosine};
    const PdfImage image = pdf_image(hemisphere_map(width), [&](const float direction[3]) {
        const double wi[3] = {double{direction[0]}, double{direction[1]}, double{direction[2]}};
        double rgb[3];
        brdf->evaluate(wo, wi, rgb);
        return static_cast<float>((0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]) * std::max(0.0, wi[2]));
    });
    return false_colour(image, automatic_range(image));
}

} // namespace acdf::tools
