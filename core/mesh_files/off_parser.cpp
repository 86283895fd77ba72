// SPDX-License-Identifier: MIT
// Object File Format: [ST][C][N]OFF in text. One vertex and one face a line; what follows them on the line (normals, colours) is passed
// over.
// By hand: assimp, as Debian has it, keeps float32 coordinates and does not say in which line a fault is.
#include <string>

#include "core/files/text_lines.hpp"
#include "core/mesh_files/raw_mesh.hpp"

namespace fettle::core::mesh_files {
namespace {

using Words = std::vector<std::string_view>;

class OffParser {
public:
    OffParser(std::string_view text, const std::string& where) : lines_(text), where_(where) {}

    Result<RawMesh> parse() {
        parse_header();
        for (int i = 0; i < vertex_count_ && errors_.empty(); ++i) parse_vertex(i);
        for (int i = 0; i < face_count_ && errors_.empty(); ++i) parse_face(i);
        if (!errors_.empty()) return errors_;
        return std::move(mesh_);
    }

private:
    /// The keyword (which may be missing), and the three counts on its line or the next.
    void parse_header() {
        if (!lines_.next(words_)) return fail(ErrorCode::parse, "is empty");
        if (words_[0].size() >= 3 && words_[0].substr(words_[0].size() - 3) == "OFF") {
            const std::string_view kind = words_[0].substr(0, words_[0].size() - 3);
            const bool text = words_.size() < 2 || words_[1] != "BINARY";
            if (!text || kind.find_first_of("4n") != std::string_view::npos) {
                return fail(ErrorCode::unsupported, "binary, 4-dimensional and n-dimensional OFF are not read; export text OFF");
            }
            words_.erase(words_.begin());
            if (words_.empty() && !lines_.next(words_)) return fail(ErrorCode::parse, "ends before the numbers of vertices and faces");
        }
        const auto vertices = files::parsed_integer(words_[0]);
        const auto faces = words_.size() > 1 ? files::parsed_integer(words_[1]) : std::nullopt;
        if (!vertices || !faces || *vertices < 0 || *faces < 0) {
            return fail(ErrorCode::parse, "does not begin with `OFF` and the numbers of vertices, faces and edges");
        }
        vertex_count_ = *vertices;
        face_count_ = *faces;
    }

    void parse_vertex(int index) {
        if (!lines_.next(words_))
            return fail(ErrorCode::parse, "ends after " + std::to_string(index) + " of " + std::to_string(vertex_count_) + " vertices");
        if (words_.size() < 3) return fail(ErrorCode::parse, "vertex " + std::to_string(index) + " needs three coordinates");
        Vector3 x;
        for (int i = 0; i < 3; ++i) {
            const auto value = files::parsed_number(words_[i]);
            if (!value) return fail(ErrorCode::parse, "`" + std::string(words_[i]) + "` is not a number");
            x(i) = *value;
        }
        mesh_.vertices.push_back(x);
    }

    void parse_face(int index) {
        if (!lines_.next(words_))
            return fail(ErrorCode::parse, "ends after " + std::to_string(index) + " of " + std::to_string(face_count_) + " faces");
        const auto count = files::parsed_integer(words_[0]);
        if (!count || *count < 1 || static_cast<std::size_t>(*count) >= words_.size()) {
            return fail(ErrorCode::parse, "face " + std::to_string(index) + " needs its number of vertices and as many indices");
        }
        std::vector<int> corners;
        for (std::size_t i = 1; i <= static_cast<std::size_t>(*count); ++i) {
            const auto vertex = files::parsed_integer(words_[i]);
            if (!vertex || *vertex < 0 || *vertex >= vertex_count_) {
                return fail(ErrorCode::out_of_range,
                            "`" + std::string(words_[i]) + "` is not a vertex index in 0 to " + std::to_string(vertex_count_ - 1));
            }
            corners.push_back(*vertex);
        }
        if (corners.size() == 1) mesh_.points.push_back(corners[0]);
        if (corners.size() == 2) mesh_.edges.push_back({corners[0], corners[1]});
        if (corners.size() < 3) return;
        mesh_.corners.insert(mesh_.corners.end(), corners.begin(), corners.end());
        mesh_.polygon_ends.push_back(count_of(mesh_.corners));
        mesh_.polygon_group.push_back(-1);
    }

    void fail(ErrorCode code, const std::string& message) {
        errors_.push_back({code, where_ + ":" + std::to_string(lines_.line_number()), message});
    }

    files::TextLines lines_;
    std::string where_;
    Words words_;
    RawMesh mesh_;
    Errors errors_;
    int vertex_count_ = 0, face_count_ = 0;
};

}  // namespace

Result<RawMesh> parse_off(std::string_view text, const std::string& where) { return OffParser(text, where).parse(); }

}  // namespace fettle::core::mesh_files
