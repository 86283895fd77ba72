// SPDX-License-Identifier: MIT
#include "design/tolerances/iso286.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>

#include "core/base/units.hpp"
#include "design/tolerances/size_steps.hpp"

namespace fettle::design::tolerances {

namespace {

constexpr double um = 1e6;  // in one metre: 21 / um is 2.1e-5 correctly rounded, 21 * 1e-6 is not always
constexpr double smallest_for_all = 1e-3, end_of_first_step = 3e-3, largest = 0.5;
constexpr int finest_grade = 5, coarsest_grade = 14;

/// Standard tolerance grades [um]. IT4 is no grade of ours: Delta of IT5 needs it.
struct GradeStep {
    double up_to;             // [mm]
    std::array<int, 11> it4;  // IT4 to IT14

    int width(int grade) const { return it4[static_cast<std::size_t>(grade - 4)]; }
};

constexpr GradeStep grade_steps[] = {
    // clang-format off
    {  3, { 3,  4,  6, 10, 14,  25,  40,  60, 100, 140,  250}},
    {  6, { 4,  5,  8, 12, 18,  30,  48,  75, 120, 180,  300}},
    { 10, { 4,  6,  9, 15, 22,  36,  58,  90, 150, 220,  360}},
    { 18, { 5,  8, 11, 18, 27,  43,  70, 110, 180, 270,  430}},
    { 30, { 6,  9, 13, 21, 33,  52,  84, 130, 210, 330,  520}},
    { 50, { 7, 11, 16, 25, 39,  62, 100, 160, 250, 390,  620}},
    { 80, { 8, 13, 19, 30, 46,  74, 120, 190, 300, 460,  740}},
    {120, {10, 15, 22, 35, 54,  87, 140, 220, 350, 540,  870}},
    {180, {12, 18, 25, 40, 63, 100, 160, 250, 400, 630, 1000}},
    {250, {14, 20, 29, 46, 72, 115, 185, 290, 460, 720, 1150}},
    {315, {16, 23, 32, 52, 81, 130, 210, 320, 520, 810, 1300}},
    {400, {18, 25, 36, 57, 89, 140, 230, 360, 570, 890, 1400}},
    {500, {20, 27, 40, 63, 97, 155, 250, 400, 630, 970, 1550}},
    // clang-format on
};

constexpr std::string_view letters[] = {"c", "d", "e", "f", "g", "h", "js", "k", "m", "n", "p", "r", "s"};

/// Fundamental deviations of shafts [um]: -es of c to h, ei of k to s, of k in the grades up to IT7. The standard divides 10 to 18 mm and
/// 18 to 30 mm once more, which changes none of these letters.
struct DeviationStep {
    double up_to;  // [mm]
    int c, d, e, f, g, k, m, n, p, r, s;

    int deviation(std::string_view letter) const {
        switch (letter[0]) {
            case 'c':
                return c;
            case 'd':
                return d;
            case 'e':
                return e;
            case 'f':
                return f;
            case 'g':
                return g;
            case 'k':
                return k;
            case 'm':
                return m;
            case 'n':
                return n;
            case 'p':
                return p;
            case 'r':
                return r;
            case 's':
                return s;
            default:
                return 0;  // h; js does not ask
        }
    }
};

constexpr DeviationStep deviation_steps[] = {
    // clang-format off
    //     c    d    e   f   g  k   m   n   p    r    s
    {  3,  60,  20,  14,  6,  2, 0,  2,  4,  6,  10,  14},
    {  6,  70,  30,  20, 10,  4, 1,  4,  8, 12,  15,  19},
    { 10,  80,  40,  25, 13,  5, 1,  6, 10, 15,  19,  23},
    { 18,  95,  50,  32, 16,  6, 1,  7, 12, 18,  23,  28},
    { 30, 110,  65,  40, 20,  7, 2,  8, 15, 22,  28,  35},
    { 40, 120,  80,  50, 25,  9, 2,  9, 17, 26,  34,  43},
    { 50, 130,  80,  50, 25,  9, 2,  9, 17, 26,  34,  43},
    { 65, 140, 100,  60, 30, 10, 2, 11, 20, 32,  41,  53},
    { 80, 150, 100,  60, 30, 10, 2, 11, 20, 32,  43,  59},
    {100, 170, 120,  72, 36, 12, 3, 13, 23, 37,  51,  71},
    {120, 180, 120,  72, 36, 12, 3, 13, 23, 37,  54,  79},
    {140, 200, 145,  85, 43, 14, 3, 15, 27, 43,  63,  92},
    {160, 210, 145,  85, 43, 14, 3, 15, 27, 43,  65, 100},
    {180, 230, 145,  85, 43, 14, 3, 15, 27, 43,  68, 108},
    {200, 240, 170, 100, 50, 15, 4, 17, 31, 50,  77, 122},
    {225, 260, 170, 100, 50, 15, 4, 17, 31, 50,  80, 130},
    {250, 280, 170, 100, 50, 15, 4, 17, 31, 50,  84, 140},
    {280, 300, 190, 110, 56, 17, 4, 20, 34, 56,  94, 158},
    {315, 330, 190, 110, 56, 17, 4, 20, 34, 56,  98, 170},
    {355, 360, 210, 125, 62, 18, 4, 21, 37, 62, 108, 190},
    {400, 400, 210, 125, 62, 18, 4, 21, 37, 62, 114, 208},
    {450, 440, 230, 135, 68, 20, 5, 23, 40, 68, 126, 232},
    {500, 480, 230, 135, 68, 20, 5, 23, 40, 68, 132, 252},
    // clang-format on
};

struct ToleranceClass {
    std::string letter;  // in small letters
    bool hole = false;
    int grade = 0;
};

std::string capitals(std::string_view word) {
    std::string text(word);
    for (char& letter : text) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    return text;
}

std::string covered_letters() {
    std::string shafts, holes;
    for (const std::string_view letter : letters) {
        shafts += (shafts.empty() ? "" : " ") + std::string(letter);
        holes += (holes.empty() ? "" : " ") + capitals(letter);
    }
    return shafts + " for shafts and " + holes + " for holes";
}

Result<ToleranceClass> read_class(std::string_view text, const std::string& where) {
    const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0; };
    const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    const auto middle = std::find_if_not(text.begin(), text.end(), is_letter);
    const std::string letter(text.begin(), middle), grade(middle, text.end());
    if (letter.empty() || grade.empty() || grade[0] == '0' || !std::all_of(grade.begin(), grade.end(), is_digit)) {
        return Error{
            ErrorCode::parse, where,
            "\"" + std::string(text) +
                "\" is no tolerance class of ISO 286; write a letter and a grade, such as \"H7\" for a hole or \"g6\" for a shaft"};
    }
    ToleranceClass read;
    for (const std::string_view known : letters) {
        if (letter == known || letter == capitals(known)) {
            read.letter = known;
            read.hole = letter != known;
        }
    }
    if (read.letter.empty()) {
        return Error{
            ErrorCode::out_of_range, where,
            "\"" + std::string(text) + "\": the letter \"" + letter + "\" of ISO 286 is not covered; there are " + covered_letters()};
    }
    read.grade = grade.size() > 2 ? coarsest_grade + 1 : std::stoi(grade);
    if (read.grade < finest_grade || read.grade > coarsest_grade) {
        return Error{ErrorCode::out_of_range, where,
                     "\"" + std::string(text) + "\": the grade " + grade + " of ISO 286 is not covered; there are " +
                         std::to_string(finest_grade) + " to " + std::to_string(coarsest_grade)};
    }
    return read;
}

bool up_to(double nominal, double end) { return nominal <= end + size_rounding; }

/// Why the standard has no such class at this size; nothing: it has.
std::optional<std::string> not_given(const ToleranceClass& wanted, double nominal) {
    if (wanted.grade == 14 && up_to(nominal, smallest_for_all)) return "grade 14 only over 1 mm; choose a finer grade";
    if (!wanted.hole || wanted.grade <= 8) return std::nullopt;
    if (wanted.letter == "n" && up_to(nominal, smallest_for_all)) return "N of grade 9 and coarser only over 1 mm; choose N5 to N8";
    if (wanted.letter == "k" && !up_to(nominal, end_of_first_step)) return "K of grade 9 and coarser only up to 3 mm; choose K5 to K8";
    return std::nullopt;
}

/// ES of the holes K to S [um].
int upper_of_hole(const ToleranceClass& wanted, double nominal, const GradeStep& widths, int deviation) {
    if (up_to(nominal, end_of_first_step)) return -deviation;
    if (wanted.letter == "n" && wanted.grade > 8) return 0;
    if (wanted.letter == "m" && wanted.grade == 6 && widths.up_to == 315) return -9;
    const bool transition = wanted.letter == "k" || wanted.letter == "m" || wanted.letter == "n";
    if (wanted.grade > (transition ? 8 : 7)) return -deviation;
    return -deviation + widths.width(wanted.grade) - widths.width(wanted.grade - 1);
}

}  // namespace

Result<DeviationLimits> iso286_limits(std::string_view tolerance_class, double nominal, const std::string& where) {
    const Result<ToleranceClass> wanted = read_class(tolerance_class, where);
    if (!wanted) return wanted.errors();
    if (!std::isfinite(nominal)) return Error{ErrorCode::not_finite, where, "a nominal size is a number"};
    const std::string named = "\"" + std::string(tolerance_class) + "\" at " + core::base::format_length(nominal, "mm");
    if (nominal <= 0 || !up_to(nominal, largest)) {
        return Error{ErrorCode::out_of_range, where, named + ": classes of ISO 286 are covered for sizes over 0 up to 500 mm"};
    }
    if (const auto reason = not_given(*wanted, nominal)) return Error{ErrorCode::out_of_range, where, named + ": ISO 286 gives " + *reason};

    const GradeStep& widths = *step_of(grade_steps, nominal);
    const int width = widths.width(wanted->grade);
    const auto limits = [&](double lower) { return DeviationLimits{lower / um, (lower + width) / um}; };
    if (wanted->letter == "js") return limits(-width / 2.0);
    const int deviation = step_of(deviation_steps, nominal)->deviation(wanted->letter);
    const bool clearance = wanted->letter <= "h";
    if (wanted->hole) return limits(clearance ? deviation : upper_of_hole(*wanted, nominal, widths, deviation) - width);
    if (clearance) return limits(-deviation - width);
    return limits(wanted->letter == "k" && wanted->grade > 7 ? 0 : deviation);
}

}  // namespace fettle::design::tolerances
