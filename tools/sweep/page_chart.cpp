#include "tools/sweep/page_chart.h"

#include "tools/cli/html.h"
#include "tools/cli/sizes.h"
#include "tools/sweep/advice.h"
#include "tools/sweep/text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace acdf::tools {
namespace {

constexpr double kWidth = 560.0, kHeight = 400.0, kLeft = 86.0, kRight = 22.0, kTop = 30.0, kBottom = 64.0;
constexpr double kStrip = 46.0; ///< for what a logarithm cannot show
constexpr double kSmallest = 1024.0;

std::string number(double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", v);
    return text;
}

/// One axis: values to pixels, with strips for 0 (or what is too small) and infinity.
struct Axis {
    double low = 1.0, high = 10.0; ///< values at the ends of the logarithmic part
    double begin = 0.0, end = 1.0; ///< pixels there
    bool below = false, above = false;

    double at(double value) const {
        const double strip = begin < end ? -0.5 * kStrip : 0.5 * kStrip;
        if (value < low * (1.0 - 1e-12)) return begin + strip;
        if (value > high * (1.0 + 1e-12)) return end - strip;
        return begin + (end - begin) * std::log(value / low) / std::log(high / low);
    }
};

struct Placed {
    std::size_t row = 0;
    Interval value;
};

struct Layout {
    Axis x, y;
    std::vector<double> y_ticks, x_ticks;
};

/// 1, 2 and 5 times powers of ten, or powers alone where there are many.
std::vector<double> decimal_ticks(double low, double high) {
    const double decades = std::log10(high / low);
    std::vector<double> out;
    const int every = static_cast<int>(std::ceil(decades / 7.0));
    for (int e = static_cast<int>(std::floor(std::log10(low))); e <= std::ceil(std::log10(high)); ++e)
        for (int m : {1, 2, 5}) {
            if (m > 1 && decades > 2.2) break;
            if (decades > 7.0 && e % every != 0) break;
            const double v = m * std::pow(10.0, e);
            if (v >= low * (1.0 - 1e-9) && v <= high * (1.0 + 1e-9)) out.push_back(v);
        }
    return out;
}

std::vector<double> size_ticks(double low, double high) {
    double factor = 4.0;
    while (std::log(high / low) / std::log(factor) > 6.0) factor *= 4.0;
    std::vector<double> out;
    for (double v = kSmallest; v <= high * (1.0 + 1e-9); v *= factor)
        if (v >= low * (1.0 - 1e-9)) out.push_back(v);
    return out;
}

/// Rounded outwards to 1, 2 or 5 times a power of ten.
double rounded_down(double v) {
    const double power = std::pow(10.0, std::floor(std::log10(v)));
    const double m = v / power;
    return (m >= 5.0 ? 5.0 : m >= 2.0 ? 2.0 : 1.0) * power;
}
double rounded_up(double v) {
    const double power = std::pow(10.0, std::floor(std::log10(v)));
    const double m = v / power;
    return (m <= 1.0 ? 1.0 : m <= 2.0 ? 2.0 : m <= 5.0 ? 5.0 : 10.0) * power;
}

Layout layout_of(const Sweep& sweep, const Chart& chart, const std::vector<Placed>& points) {
    Layout out;
    double y_low = HUGE_VAL, y_high = 0.0, x_low = HUGE_VAL, x_high = 0.0;
    const auto cover = [&](double v) {
        if (!(v > 0.0) || std::isinf(v)) return;
        y_low = std::min(y_low, v), y_high = std::max(y_high, v);
    };
    cover(chart.limit);
    for (const Placed& p : points) {
        for (double v : {p.value.value, p.value.low, p.value.high}) cover(v);
        out.y.below |= p.value.value <= 0.0;
        out.y.above |= std::isinf(p.value.value);
        const auto bytes = static_cast<double>(sweep.rows[p.row].bytes);
        if (bytes < kSmallest) {
            out.x.below = true;
            continue;
        }
        x_low = std::min(x_low, bytes), x_high = std::max(x_high, bytes);
    }
    if (!(y_high > 0.0)) y_low = 0.1, y_high = 1.0;
    if (!(x_high > 0.0)) x_low = kSmallest, x_high = 16.0 * kSmallest;
    out.y.low = rounded_down(y_low * 0.9), out.y.high = rounded_up(y_high * 1.1);
    out.x.low = std::max(kSmallest, x_low / 1.5), out.x.high = x_high * 1.6;
    out.x.begin = kLeft + (out.x.below ? kStrip : 0.0), out.x.end = kWidth - kRight;
    out.y.begin = kHeight - kBottom - (out.y.below ? kStrip : 0.0);
    out.y.end = kTop + (out.y.above ? kStrip : 0.0);
    out.y_ticks = decimal_ticks(out.y.low, out.y.high);
    out.x_ticks = size_ticks(out.x.low, out.x.high);
    return out;
}

std::string text_at(double x, double y, const char* anchor, const std::string& text, const char* type = "tick") {
    return "<text class=\"" + std::string(type) + "\" x=\"" + number(x) + "\" y=\"" + number(y) +
           "\" text-anchor=\"" + anchor + "\">" + escaped(text) + "</text>";
}

std::string line(const char* type, double x0, double y0, double x1, double y1) {
    return "<line class=\"" + std::string(type) + "\" x1=\"" + number(x0) + "\" y1=\"" + number(y0) + "\" x2=\"" +
           number(x1) + "\" y2=\"" + number(y1) + "\"/>";
}

std::string axes_svg(const Chart& chart, const Layout& at) {
    const double left = kLeft, right = kWidth - kRight, bottom = kHeight - kBottom;
    std::string out;
    for (double v : at.y_ticks) {
        out += line("grid", left, at.y.at(v), right, at.y.at(v));
        out += text_at(left - 8.0, at.y.at(v) + 5.0, "end", short_number(v));
    }
    for (double v : at.x_ticks) {
        out += line("grid", at.x.at(v), kTop, at.x.at(v), bottom);
        if (at.x.below && at.x.at(v) < at.x.begin + 24.0) continue; // no room beside "none"
        out += text_at(at.x.at(v), bottom + 22.0, "middle", to_readable_size(static_cast<std::uint64_t>(v)));
    }
    if (at.y.below) {
        out += line("break", left, at.y.begin, right, at.y.begin);
        out += text_at(left - 8.0, at.y.at(0.0) + 5.0, "end", "0");
    }
    if (at.y.above) {
        out += line("break", left, at.y.end, right, at.y.end);
        out += text_at(left - 8.0, at.y.at(HUGE_VAL) + 5.0, "end", "biased");
    }
    if (at.x.below) {
        out += line("break", at.x.begin, kTop, at.x.begin, bottom);
        out += text_at(at.x.at(0.0), bottom + 22.0, "middle", "none");
    }
    out += line("axis", left, bottom, right, bottom) + line("axis", left, kTop, left, bottom);
    out += text_at(0.5 * (left + right), kHeight - 12.0, "middle", "memory", "label");
    out += text_at(4.0, 16.0, "start", chart.y_label, "label");
    if (chart.limit == chart.limit && chart.limit >= at.y.low && chart.limit <= at.y.high) {
        out += line("limit", left, at.y.at(chart.limit), right, at.y.at(chart.limit));
        out += text_at(right - 4.0, at.y.at(chart.limit) - 7.0, "end", chart.limit_label, "limit-label");
    }
    return out;
}

/// A shape of about radius r around (x, y), by the number of a kind of file.
std::string shape(std::size_t index, double x, double y, double r) {
    const auto polygon = [&](std::initializer_list<std::pair<double, double>> corners) {
        std::string points;
        for (const auto& [dx, dy] : corners)
            points += (points.empty() ? "" : " ") + number(x + dx * r) + "," + number(y + dy * r);
        return "<polygon points=\"" + points + "\"/>";
    };
    switch (index % 5) {
    case 0:
        return "<circle cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"" + number(r) + "\"/>";
    case 1:
        return polygon({{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}});
    case 2:
        return polygon({{0.0, -1.2}, {1.2, 0.0}, {0.0, 1.2}, {-1.2, 0.0}});
    case 3:
        return polygon({{0.0, -1.2}, {1.1, 0.8}, {-1.1, 0.8}});
    default:
        return polygon({{0.0, 1.2}, {1.1, -0.8}, {-1.1, -0.8}});
    }
}

std::string tooltip(const SweepRow& row, const Chart& chart, const Interval& v) {
    std::string out = row.label + (row.options.empty() ? "" : " (" + row.options + ")") + ": " +
                      to_readable_size(row.bytes) + ", " + chart.y_label + " " + short_number(v.value);
    if (v.low == v.low && v.low != v.high) out += " (" + short_number(v.low) + " to " + short_number(v.high) + ")";
    return out;
}

std::string point_group(const Sweep& sweep, const Chart& chart, const ReportSeries& series, const Placed& p,
                        const std::string& inside) {
    const SweepRow& row = sweep.rows[p.row];
    return "<g class=\"point " + std::string(series.ours ? "f" : "r") + std::to_string(series.index % 5) +
           "\" data-chart=\"" + chart.id + "\" data-row=\"" + std::to_string(p.row) + "\" data-system=\"" +
           escaped(row.system) + "\" data-file=\"" + escaped(row.file) + "\" data-bytes=\"" +
           std::to_string(row.bytes) + "\" data-variance=\"" + exact_text(row.relative_variance) +
           "\" data-value=\"" + exact_text(p.value.value) + "\"><title>" + escaped(tooltip(row, chart, p.value)) +
           "</title>" + inside + "</g>\n";
}

/// Finds room for a baseline's letter beside its dot.
class Labels {
public:
    void block(double x, double y) { taken_.push_back({x, y}); }
    std::string place(double x, double y, const std::string& letter) {
        constexpr std::pair<double, double> ways[] = {{15, 0},   {-15, 0}, {0, -16},   {0, 16},
                                                      {14, -14}, {14, 14}, {-14, -14}, {-14, 14},
                                                      {29, 0},   {-29, 0}, {27, -13},  {-27, -13}};
        double best = -1.0;
        std::pair<double, double> at{x, y};
        for (const auto& [dx, dy] : ways) {
            const double cx = x + dx, cy = y + dy;
            if (cx < kLeft + 8.0 || cx > kWidth - 10.0 || cy < kTop || cy > kHeight - kBottom - 4.0) continue;
            double room = 14.0; // enough is enough: the first way that has it
            for (const auto& [tx, ty] : taken_) room = std::min(room, std::hypot(cx - tx, cy - ty));
            if (room > best) best = room, at = {cx, cy};
        }
        taken_.push_back(at);
        return text_at(at.first, at.second + 5.0, "middle", letter, "letter");
    }

private:
    std::vector<std::pair<double, double>> taken_;
};

std::string error_bar(const Layout& at, double x, const Interval& v) {
    if (!(v.low > 0.0) || std::isinf(v.high) || v.low == v.high) return "";
    return line("error", x, at.y.at(v.low), x, at.y.at(v.high));
}

std::string path_svg(const ReportSeries& series, const std::vector<std::pair<double, double>>& points) {
    if (points.size() < 2) return "";
    std::string path;
    for (const auto& [x, y] : points) path += (path.empty() ? "M" : "L") + number(x) + " " + number(y);
    return "<path class=\"line " + std::string(series.ours ? "f" : "r") + std::to_string(series.index % 5) +
           "\" d=\"" + path + "\"/>\n";
}

} // namespace

std::string ReportSeries::letter() const { return std::string(1, static_cast<char>('A' + index % 26)); }

std::vector<ReportSeries> series_of(const Sweep& sweep) {
    std::vector<ReportSeries> out;
    std::size_t counts[2] = {0, 0};
    for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
        const SweepRow& row = sweep.rows[i];
        const auto same = [&](const ReportSeries& s) {
            const SweepRow& first = sweep.rows[s.rows.front()];
            return first.system == row.system && first.file == row.file;
        };
        const auto found = std::find_if(out.begin(), out.end(), same);
        if (found == out.end()) {
            out.push_back({row.ours(), counts[row.ours()]++, row.label, {i}});
            continue;
        }
        found->rows.push_back(i);
        if (found->label == row.label) continue;
        const auto end =
            std::mismatch(found->label.begin(), found->label.end(), row.label.begin(), row.label.end());
        std::string common(found->label.begin(), end.first); // "CDF downsampled to ", up to a word's end
        common.erase(std::min(common.size(), common.find_last_of(' ') + 1));
        while (!common.empty() && common.back() == ' ') common.pop_back();
        found->label = common + " ...";
    }
    for (ReportSeries& s : out)
        std::stable_sort(s.rows.begin(), s.rows.end(),
                         [&](std::size_t a, std::size_t b) { return sweep.rows[a].bytes < sweep.rows[b].bytes; });
    return out;
}

std::string series_mark(const ReportSeries& series) {
    const std::string type = std::string(series.ours ? "f" : "r") + std::to_string(series.index % 5);
    std::string out = "<svg class=\"mark\" viewBox=\"0 0 40 20\" aria-hidden=\"true\">";
    if (series.ours) {
        out += "<path class=\"line " + type + "\" d=\"M2 10L38 10\"/><g class=\"point " + type + "\">" +
               shape(series.index, 20.0, 10.0, 6.0) + "</g>";
    } else {
        out += "<g class=\"point " + type + "\"><circle cx=\"12\" cy=\"10\" r=\"5\"/>" +
               text_at(28.0, 15.0, "middle", series.letter(), "letter") + "</g>";
    }
    return out + "</svg>";
}

std::string chart_svg(const Sweep& sweep, const Chart& chart, const std::vector<std::size_t>& recommended) {
    const std::vector<ReportSeries> all = series_of(sweep);
    std::vector<std::vector<Placed>> placed(all.size());
    std::vector<Placed> points;
    for (std::size_t s = 0; s < all.size(); ++s)
        for (std::size_t row : all[s].rows)
            if (const Interval v = chart.value(sweep, sweep.rows[row]); v.known()) {
                placed[s].push_back({row, v});
                points.push_back({row, v});
            }
    if (points.empty()) return "";
    const Layout at = layout_of(sweep, chart, points);
    const auto place = [&](const Placed& p) {
        return std::pair<double, double>{at.x.at(static_cast<double>(sweep.rows[p.row].bytes)),
                                         at.y.at(p.value.value)};
    };
    std::string lines, marks;
    Labels labels;
    for (const Placed& p : points) labels.block(place(p).first, place(p).second);
    for (std::size_t s = 0; s < all.size(); ++s) {
        std::vector<std::pair<double, double>> path;
        for (const Placed& p : placed[s]) path.push_back(place(p));
        lines += path_svg(all[s], path);
    }
    // Baselines first: what is recommended shall not be hidden.
    for (int ours = 0; ours < 2; ++ours)
        for (std::size_t s = all.size(); s-- > 0;) {
            if (all[s].ours != (ours == 1)) continue;
            for (const Placed& p : placed[s]) {
                const auto [x, y] = place(p);
                std::string inside = error_bar(at, x, p.value);
                if (std::find(recommended.begin(), recommended.end(), p.row) != recommended.end())
                    inside +=
                        "<circle class=\"chosen\" cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"12\"/>";
                inside += all[s].ours ? shape(all[s].index, x, y, 6.0) : shape(0, x, y, 5.0);
                if (!all[s].ours) inside += labels.place(x, y, all[s].letter());
                marks += point_group(sweep, chart, all[s], p, inside);
            }
        }
    return "<svg class=\"chart\" id=\"chart-" + chart.id +
           "\" viewBox=\"0 0 560 400\" role=\"img\" "
           "aria-labelledby=\"title-" +
           chart.id + " about-" + chart.id + "\">\n<title id=\"title-" + chart.id + "\">" + escaped(chart.title) +
           "</title><desc id=\"about-" + chart.id + "\">" + escaped(chart.about) +
           " All numbers are in the table of all rows.</desc>\n" + axes_svg(chart, at) + "\n" + lines + marks +
           "</svg>\n";
}

} // namespace acdf::tools
