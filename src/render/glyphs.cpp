#include "render/glyphs.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>

namespace grainray::picture {

namespace {

constexpr float capital = 28;  // height in font units; small letters are 20 high
constexpr float gap = 7, blank = 10;

// One letter a command, then whole numbers: M moves, L draws a line, q a quadratic curve (control, end), h and v the quarter
// of an ellipse that sets out horizontally or vertically.
struct Drawing { char letter; const char* path; };
constexpr Drawing drawings[] = {
    {'0', "M0 14v8 28h16 14v8 0h0 14"}, {'1', "M3 22L10 28L10 0"}, {'2', "M1 20v8 28h15 20q15 15 9 9L0 0L16 0"},
    {'3', "M1 24q3 28 8 28h15 21v8 15L6 15M8 15h16 8v8 0q2 0 0 5"}, {'4', "M13 0L13 28L0 8L18 8"},
    {'5', "M14 28L3 28L2 16q5 18 8 18h16 9v8 0q3 0 0 4"}, {'6', "M14 26q12 28 9 28h0 13v8 0h16 9v8 18h0 9"},
    {'7', "M0 28L16 28L5 0"}, {'8', "M8 15h1 21v8 28h15 21v8 15h16 8v8 0h0 8v8 15"}, {'9', "M2 2q4 0 7 0h16 15v8 28h0 19v8 10h16 19"},
    {'.', "M1 0L1 0"}, {',', "M3 1L1 -6"}, {':', "M1 1L1 1M1 17L1 17"}, {'-', "M0 11L11 11"}, {'+', "M0 12L16 12M8 4L8 20"},
    {'=', "M0 8L16 8M0 16L16 16"}, {'(', "M7 32q0 24 0 12q0 0 7 -8"}, {')', "M0 32q7 24 7 12q7 0 0 -8"}, {'/', "M0 -4L11 31"},
    {'%', "M1 23v5 28h9 23v5 18h1 23M17 28L6 0M13 5v17 10h21 5v17 0h13 5"}, {'_', "M0 -5L16 -5"}, {'[', "M6 32L0 32L0 -7L6 -7"},
    {']', "M0 32L6 32L6 -7L0 -7"}, {'*', "M0 18L12 26M0 26L12 18M6 15L6 29"}, {'?', "M1 22v8 28h15 21q15 16 8 13L8 9M8 0L8 0"},
    {'a', "M15 20L15 0M15 10v7 20h0 10v7 0h15 10"}, {'b', "M0 29L0 0M0 10v8 20h15 10v8 0h0 10"},
    {'c', "M14 16q12 20 8 20h0 10v8 0q12 0 14 4"}, {'d', "M15 29L15 0M15 10v7 20h0 10v7 0h15 10"},
    {'e', "M0 10L15 10v8 20h0 10v8 0q12 0 14 4"}, {'f', "M9 29q4 29 4 24L4 0M0 20L9 20"},
    {'g', "M15 20L15 -1v7 -9q3 -9 1 -6M15 10v7 20h0 10v7 0h15 10"}, {'h', "M0 29L0 0M0 12v7 20h14 13L14 0"},
    {'i', "M0 20L0 0M0 27L0 27"}, {'j', "M4 20L4 -4q4 -9 0 -9M4 27L4 27"}, {'k', "M0 29L0 0M13 20L0 8M5 12L14 0"}, {'l', "M0 29L0 0"},
    {'m', "M0 20L0 0M0 13v6 20h12 14L12 0M12 13v18 20h24 14L24 0"}, {'n', "M0 20L0 0M0 12v7 20h14 13L14 0"},
    {'o', "M0 10v8 20h16 10v8 0h0 10"}, {'p', "M0 20L0 -9M0 10v8 20h15 10v8 0h0 10"}, {'q', "M15 20L15 -9M15 10v7 20h0 10v7 0h15 10"},
    {'r', "M0 20L0 0M0 11v9 20"}, {'s', "M13 17q11 20 7 20h1 15q1 11 7 10q13 9 13 5v7 0q2 0 0 4"}, {'t', "M4 26L4 5q4 0 9 0M0 20L9 20"},
    {'u', "M0 20L0 7v7 0h14 8M14 20L14 0"}, {'v', "M0 20L8 0L16 20"}, {'w', "M0 20L6 0L12 20L18 0L24 20"}, {'x', "M0 20L14 0M14 20L0 0"},
    {'y', "M0 20L8 0M16 20L8 0L6 -5q4 -9 0 -9"}, {'z', "M0 20L14 20L0 0L14 0"},
    {'A', "M0 0L10 28L20 0M4 9L16 9"}, {'B', "M0 0L0 28L9 28h16 21v9 15L0 15M9 15h18 7v9 0L0 0"},
    {'C', "M20 23q17 28 11 28h0 14v11 0q17 0 20 5"}, {'D', "M0 0L0 28L8 28h20 14v8 0L0 0"}, {'E', "M15 28L0 28L0 0L15 0M0 15L13 15"},
    {'F', "M15 28L0 28L0 0M0 15L13 15"}, {'G', "M20 23q17 28 11 28h0 14v11 0h20 9L20 13L12 13"}, {'H', "M0 0L0 28M18 0L18 28M0 15L18 15"},
    {'I', "M0 0L0 28"}, {'J', "M11 28L11 7v5 0h0 6"}, {'K', "M0 0L0 28M17 28L0 11M6 16L18 0"}, {'L', "M0 28L0 0L14 0"},
    {'M', "M0 0L0 28L11 8L22 28L22 0"}, {'N', "M0 0L0 28L18 0L18 28"}, {'O', "M0 14v11 28h22 14v11 0h0 14"},
    {'P', "M0 0L0 28L9 28h17 20v9 13L0 13"}, {'Q', "M0 14v11 28h22 14v11 0h0 14M14 7L22 -2"},
    {'R', "M0 0L0 28L9 28h17 20v9 13L0 13M9 13L18 0"}, {'S', "M17 23q15 28 9 28h1 21q1 16 9 14q18 12 18 7v9 0q2 0 0 6"},
    {'T', "M0 28L20 28M10 28L10 0"}, {'U', "M0 28L0 9v9 0h18 9L18 28"}, {'V', "M0 28L10 0L20 28"}, {'W', "M0 28L7 0L14 28L21 0L28 28"},
    {'X', "M0 28L18 0M18 28L0 0"}, {'Y', "M0 28L10 13L20 28M10 13L10 0"}, {'Z', "M0 28L17 28L0 0L17 0"},
};

class Pen {
public:
    explicit Pen(std::string_view path) {
        for (rest_ = path; !rest_.empty();) command();
    }
    Lettering result;

private:
    void command() {
        const char what = rest_.front();
        rest_.remove_prefix(1);
        const float a = number(), b = number();
        if (what == 'M') move(a, b);
        else if (what == 'L') line(a, b);
        else if (what == 'q') {
            const float c = number(), d = number();
            curve([=, x = x_, y = y_](float t) {
                const float s = 1 - t;
                return std::pair{s * s * x + 2 * s * t * a + t * t * c, s * s * y + 2 * s * t * b + t * t * d};
            });
        } else {
            curve([=, x = x_, y = y_](float t) {
                const float angle = t * std::numbers::pi_v<float> / 2, rise = std::sin(angle), fall = 1 - std::cos(angle);
                return std::pair{x + (a - x) * (what == 'h' ? rise : fall), y + (b - y) * (what == 'h' ? fall : rise)};
            });
        }
    }
    float number() {
        while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
        int value = 0;
        const auto end = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value).ptr;
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return static_cast<float>(value);
    }
    void move(float x, float y) { x_ = x, y_ = y; }
    void line(float x, float y) {
        result.strokes.push_back({x_, y_, x, y});
        result.width = std::max({result.width, x_, x});
        move(x, y);
    }
    template <class Curve>
    void curve(const Curve& at) {
        constexpr int pieces = 8;
        for (int k = 1; k <= pieces; ++k) {
            const auto [x, y] = at(static_cast<float>(k) / pieces);
            line(x, y);
        }
    }

    std::string_view rest_;
    float x_ = 0, y_ = 0;
};

const Lettering& glyph(char letter) {
    static const auto font = [] {
        std::map<char, Lettering> all;
        for (const Drawing& d : drawings) all[d.letter] = Pen(d.path).result;
        return all;
    }();
    const auto found = font.find(letter);
    return found == font.end() ? font.at('?') : found->second;
}

}  // namespace

Lettering letter(std::string_view text) {
    Lettering line;
    float x = 0, scale = 1 / capital, lift = 0;
    for (const char c : text) {
        if (c == '^') {
            scale = 0.65f / capital, lift = 0.5f;
        } else if (c == ' ') {
            scale = 1 / capital, lift = 0;
            x += (blank + gap) * scale;
        } else {
            const Lettering& g = glyph(c);
            for (const Stroke& s : g.strokes)
                line.strokes.push_back({x + s.x0 * scale, lift + s.y0 * scale, x + s.x1 * scale, lift + s.y1 * scale});
            line.width = x + g.width * scale;
            x += (g.width + gap) * scale;
        }
    }
    return line;
}

}  // namespace grainray::picture
