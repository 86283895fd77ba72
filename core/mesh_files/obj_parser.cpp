// SPDX-License-Identifier: MIT
// Wavefront OBJ: v, f, l, p, o, g; appearance is passed over, free-form surfaces are refused.
// By hand: assimp, as Debian has it, keeps float32 coordinates and does not say in which line a fault is.
#include <algorithm>
#include <array>
#include <string>
#include <unordered_map>

#include "core/files/text_lines.hpp"
#include "core/mesh_files/raw_mesh.hpp"

namespace fettle::core::mesh_files {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::array<std::string_view, 15> passed_over = {
    "vn", "vt", "vp", "s", "mg", "usemtl", "mtllib", "usemap", "maplib", "lod", "shadow_obj", "trace_obj", "bevel", "c_interp", "d_interp"};
constexpr std::array<std::string_view, 14> free_form = {"cstype", "deg",  "bmat", "step", "curv", "curv2", "surf",
                                                        "parm",   "trim", "hole", "scrv", "sp",   "con",   "end"};

template <class List>
bool is_among(std::string_view word, const List& list) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

class ObjParser {
public:
    ObjParser(std::string_view text, const std::string& where) : lines_(text), where_(where) {}

    Result<RawMesh> parse() {
        Words words;
        while (errors_.empty() && lines_.next(words)) parse_line(words);
        if (errors_.empty()) check_forward_references();
        if (!errors_.empty()) return errors_;
        return std::move(mesh_);
    }

private:
    void parse_line(const Words& words) {
        const std::string_view key = words[0];
        if (key == "v") {
            parse_vertex(words);
        } else if (key == "f" || key == "fo") {
            parse_face(words);
        } else if (key == "l") {
            parse_polyline(words);
        } else if (key == "p") {
            for (std::size_t i = 1; i < words.size(); ++i) mesh_.points.push_back(vertex_index(words[i]));
        } else if (key == "o" || key == "g") {
            start_group(words);
        } else if (is_among(key, free_form)) {
            fail(ErrorCode::unsupported, "`" + std::string(key) + "` is a free-form curve or surface; export the model as polygons");
        } else if (!is_among(key, passed_over)) {
            fail(ErrorCode::parse, "`" + std::string(key.substr(0, 20)) + "` is not a keyword of OBJ that is read");
        }
    }

    void parse_vertex(const Words& words) {
        Vector3 x = Vector3::Zero();  // x y [z], then a weight or a colour, which is passed over
        if (words.size() < 3) return fail(ErrorCode::parse, "a vertex needs coordinates `v x y z`");
        for (std::size_t i = 1; i < std::min<std::size_t>(words.size(), 4); ++i) {
            const auto value = files::parsed_number(words[i]);
            if (!value) return fail(ErrorCode::parse, "`" + std::string(words[i]) + "` is not a number");
            x(static_cast<int>(i) - 1) = *value;
        }
        mesh_.vertices.push_back(x);
    }

    void parse_face(const Words& words) {
        if (words.size() < 3) return fail(ErrorCode::parse, "a face needs at least two vertices");
        if (words.size() == 3) {
            const int from = vertex_index(words[1]), to = vertex_index(words[2]);
            mesh_.edges.push_back({from, to});
            return;
        }
        for (std::size_t i = 1; i < words.size(); ++i) mesh_.corners.push_back(vertex_index(words[i]));
        mesh_.polygon_ends.push_back(count_of(mesh_.corners));
        mesh_.polygon_group.push_back(group_);
    }

    void parse_polyline(const Words& words) {
        for (std::size_t i = 2; i < words.size(); ++i) mesh_.edges.push_back({vertex_index(words[i - 1]), vertex_index(words[i])});
    }

    /// "7", "7/2", "7//3", "-1/..": the number before the first slash, from 1, or from the last vertex so far if negative.
    int vertex_index(std::string_view word) {
        const auto number = files::parsed_integer(word.substr(0, word.find('/')));
        const int count = count_of(mesh_.vertices);
        if (!number || *number == 0 || (*number < 0 && *number + count < 0)) {
            fail(ErrorCode::out_of_range,
                 "`" + std::string(word) + "` is not a vertex: counted from 1, or -1 to -" + std::to_string(count) + " for the last ones");
            return 0;
        }
        if (*number > largest_index_) {
            largest_index_ = *number;
            line_of_largest_ = lines_.line_number();
        }
        return *number > 0 ? *number - 1 : count + *number;
    }

    void start_group(const Words& words) {
        std::string name;
        for (std::size_t i = 1; i < words.size(); ++i) {
            if (i > 1) name += ' ';
            name += words[i];
        }
        // `o` before `g` (or the reverse) names one object twice: the later name holds for the faces that follow it.
        group_ = -1;
        if (name.empty() || name == "default") return;
        const auto [known, fresh] = group_of_.try_emplace(name, count_of(mesh_.groups));
        group_ = known->second;
        if (fresh) mesh_.groups.push_back(name);
    }

    void check_forward_references() {
        const int count = count_of(mesh_.vertices);
        if (largest_index_ <= count) return;
        errors_.push_back({ErrorCode::out_of_range, where_ + ":" + std::to_string(line_of_largest_),
                           "refers to vertex " + std::to_string(largest_index_) + ", but the file has " + std::to_string(count)});
    }

    void fail(ErrorCode code, const std::string& message) {
        errors_.push_back({code, where_ + ":" + std::to_string(lines_.line_number()), message});
    }

    files::TextLines lines_;
    std::string where_;
    RawMesh mesh_;
    Errors errors_;
    std::unordered_map<std::string, int> group_of_;
    int group_ = -1;
    int largest_index_ = 0;  ///< counted from 1
    int line_of_largest_ = 0;
};

}  // namespace

Result<RawMesh> parse_obj(std::string_view text, const std::string& where) { return ObjParser(text, where).parse(); }

}  // namespace fettle::core::mesh_files
