// SPDX-License-Identifier: MIT
/// fettle coupon: a test plate, and the form for what is measured of it (design/coupons).
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/nearest_word.hpp"
#include "core/mesh_files/mesh_writer.hpp"
#include "design/cli/command.hpp"
#include "design/coupons/coupon_form.hpp"
#include "design/coupons/coupon_solid.hpp"
#include "design/exports/profile_drawing.hpp"
#include "design/tolerances/known_processes.hpp"

namespace fettle::design::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using coupons::Coupon;
using coupons::CouponKind;

constexpr double deposited = 6e-9;  ///< by which a filament printer's time is estimated [m^3/s]

struct CouponArguments {
    std::string process = "mine", out;
    int steps = 6;
    std::vector<std::string> sizes;
};

std::string extension_of(const std::string& out) {
    std::string extension = fs::path(out).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension;
}

Result<CouponKind> kind_of(const std::string& out) {
    const std::string extension = extension_of(out);
    for (const char* cut : {".svg", ".dxf"})
        if (extension == cut) return CouponKind::cut;
    for (const char* printed : {".3mf", ".stl", ".obj"})
        if (extension == printed) return CouponKind::printed;
    return Error{ErrorCode::unsupported, "--out",
                 "found " + out + "; a coupon to print is X.3mf, X.stl or X.obj, one to cut X.svg or X.dxf"};
}

// "hole=3mm..8mm"
Result<coupons::SizeRange> size_range(const std::string& text, CouponKind coupon) {
    const Error fault{ErrorCode::parse, "--sizes", "found \"" + text + "\"; sizes are given as hole=3mm..8mm"};
    const std::size_t equals = text.find('='), dots = text.find("..");
    if (equals == std::string::npos || dots == std::string::npos || dots < equals) return fault;
    const std::string name = text.substr(0, equals);
    const auto kind = tolerances::feature_kind(name);
    std::vector<std::string_view> names;
    for (const tolerances::FeatureKind each : coupons::sized_kinds(coupon)) names.emplace_back(tolerances::to_string(each));
    if (!kind || std::find(names.begin(), names.end(), name) == names.end())
        return Error{ErrorCode::out_of_range, "--sizes",
                     "a coupon " + std::string(coupon == CouponKind::cut ? "to cut" : "to print") + " has no features of kind \"" + name +
                         "\"; " + core::files::did_you_mean(name, names)};
    const auto from = core::base::parse_length(text.substr(equals + 1, dots - equals - 1), "--sizes");
    const auto up_to = core::base::parse_length(text.substr(dots + 2), "--sizes");
    if (!from) return from.errors();
    if (!up_to) return up_to.errors();
    return coupons::SizeRange{*kind, *from, *up_to};
}

Result<coupons::CouponOptions> options_of(const CouponArguments& arguments) {
    const Result<CouponKind> kind = kind_of(arguments.out);
    if (!kind) return kind.errors();
    coupons::CouponOptions options{*kind, arguments.steps, {}};
    Errors errors;
    for (const std::string& text : arguments.sizes) {
        const auto range = size_range(text, *kind);
        errors.insert(errors.end(), range.errors().begin(), range.errors().end());
        if (range) options.sizes.push_back(*range);
    }
    if (!errors.empty()) return errors;
    return options;
}

/// The geometry's bytes, and how much material it is; of a cut one 0 [m^3].
struct Made {
    std::string bytes;
    double volume = 0;
};

Result<Made> make(const Coupon& coupon, const std::string& extension) {
    Made made;
    if (coupon.kind == CouponKind::cut) {
        if (extension == ".dxf") {
            const auto outline = coupon_outline(coupon);
            if (!outline) return outline.errors();
            made.bytes = exports::profile_dxf(*outline);
            return made;
        }
        Result<std::string> text = coupon_svg(coupon);
        if (!text) return text.errors();
        made.bytes = *std::move(text);
        return made;
    }
    const auto mesh = coupon_mesh(coupon);
    if (!mesh) return mesh.errors();
    made.volume = coupons::volume_of(*mesh);
    const std::vector<core::mesh_files::MeshPart> parts{{"coupon", &*mesh}};
    if (extension == ".stl") made.bytes = core::mesh_files::stl_bytes(parts);
    if (extension == ".obj") made.bytes = core::mesh_files::obj_text(parts);
    if (extension != ".3mf") return made;
    Result<std::string> bytes = core::mesh_files::threemf_bytes(parts);
    if (!bytes) return bytes.errors();
    made.bytes = *std::move(bytes);
    return made;
}

// Neither a coupon nor a form that somebody has filled in is replaced.
Errors there_already(const std::vector<fs::path>& files) {
    Errors errors;
    for (const fs::path& path : files) {
        std::error_code code;
        if (fs::exists(path, code))
            errors.push_back({ErrorCode::inconsistent, path.string(), "is there already, and is left as it is; give --out another name"});
    }
    return errors;
}

std::string told(const Coupon& coupon, const Made& made, const CouponArguments& arguments, const fs::path& form) {
    using core::base::formatted;
    const bool is_known = tolerances::find_known_process(arguments.process) != nullptr;
    const char* usual = coupon.kind == CouponKind::cut ? "laser" : "fdm";
    const std::string name = is_known ? "my_" + arguments.process : arguments.process, base = is_known ? arguments.process : usual;
    std::string text = arguments.out + "\n" + form.string() + "\n";
    text += formatted("%.1f x %.1f mm", coupon.width * 1e3, coupon.depth * 1e3);
    if (coupon.kind == CouponKind::printed)
        text += formatted(" x %.1f mm (features up to 9 mm), %.1f cm^3: about %.0f minutes of a filament printer at %.0f mm^3/s",
                          coupon.thickness * 1e3, made.volume * 1e6, made.volume / deposited / 60, deposited * 1e9);
    return text + "\nnext: make it as you make your parts, write what you measure [mm] into " + form.string() +
           ", then\n      fettle process " + form.string() + " --name " + name + (base == "fdm" ? "" : " --based-on " + base) + "\n";
}

int run_coupon(const CouponArguments& arguments, Console& console) {
    const Result<coupons::CouponOptions> options = options_of(arguments);
    if (!options) return console.input_errors(options.errors());
    const fs::path form = fs::path(arguments.out).replace_extension(".csv");
    if (const Errors errors = there_already({arguments.out, form}); !errors.empty()) return console.input_errors(errors);
    const Result<Coupon> coupon = coupons::coupon(*options);
    if (!coupon) return console.input_errors(coupon.errors());
    const Result<Made> made = make(*coupon, extension_of(arguments.out));
    if (!made) return console.input_errors(made.errors());
    const auto rows = form_of(*coupon);
    core::files::FilesTogether files;
    Errors errors = files.add(arguments.out, made->bytes);
    if (errors.empty()) errors = files.add(form, coupons::form_text(rows));
    if (errors.empty()) errors = files.take_names();
    if (!errors.empty()) return console.input_errors(errors);
    Json features = Json::array();
    for (const auto& row : rows) features.push_back({{"feature", row.name}, {"kind", to_string(row.kind)}, {"nominal", row.nominal}});
    Json json = {{"status", "ok"},
                 {"files", {arguments.out, form.string()}},
                 {"size", {coupon->width, coupon->depth, coupon->thickness}},
                 {"features", std::move(features)}};
    if (coupon->kind == CouponKind::printed) {
        json["volume"] = made->volume;
        json["estimated_minutes"] = made->volume / deposited / 60;
    }
    console.result(json, told(*coupon, *made, arguments, form));
    return exit_done;
}

}  // namespace

Command add_coupon(CommandLine& program) {
    CommandLine app = program.command("coupon", "Makes a test plate that shows what your printer or laser makes of holes, pins, walls");
    auto options = std::make_shared<CouponArguments>();
    app.option("--out", options->out,
               "X.3mf, X.stl or X.obj to print, X.svg or X.dxf to cut; the form for what you measure is X.csv beside it")
        .required();
    app.option("--process", options->process,
               "What the measured process will be called (default mine); of a known one: what it is based on")
        .words_or(tolerances::known_process_names(), "NAME");
    app.option("--steps", options->steps, "Features of each kind, of rising size (default 6)")
        .between(coupons::least_steps, coupons::most_steps);
    app.option("--sizes", options->sizes, "Sizes of a kind, hole=3mm..8mm: hole, pin, slot, wall, gap, height (can be given several times)")
        .one_value_each();
    app.closing_words(
        "Example:  fettle coupon --process mine --out coupon.3mf\n"
        "Rows of holes (H), pins (P), slots (S), walls (W) and gaps between two walls (G), their sizes in mm below them; pins rise to\n"
        "different heights, measured from the underside. To cut: holes, slots, and fingers (W) with gaps (G) on the edge. Print it as you\n"
        "print your parts (the same material, layers, slicer settings), measure each feature once to three times, and fettle process\n"
        "makes a process of it. Nothing that is there is replaced.");
    return {app, [options](Console& console) { return run_coupon(*options, console); }};
}

}  // namespace fettle::design::cli
