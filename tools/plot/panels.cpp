#include "tools/plot/panels.h"

#include "images/module.h"
#include "tools/plot/colour.h"

#include <algorithm>

namespace acdf::tools {

images::Picture arranged(const std::vector<Panel>& panels, int columns, const std::string& font) {
    const int width = panels.front().picture.width, height = panels.front().picture.height;
    const int size = std::clamp(height / 16, 12, 24), label = 2 * size, gap = size;
    const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
    images::Picture out(columns * (width + gap) - gap, rows * (label + height));
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) std::copy(background.begin(), background.end(), out.at(x, y));
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const int x = static_cast<int>(i) % columns * (width + gap),
                  y = static_cast<int>(i) / columns * (label + height) + label;
        for (int row = 0; row < height; ++row)
            std::copy_n(panels[i].picture.at(0, row), 3 * width, out.at(x, y + row));
        constexpr Colour text = {0.12f, 0.12f, 0.12f};
        if (!font.empty())
            images::text_module().draw(out, x, y - size / 2, panels[i].label.c_str(), size, font, text.data());
    }
    return out;
}

} // namespace acdf::tools
