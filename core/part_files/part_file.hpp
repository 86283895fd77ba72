// SPDX-License-Identifier: MIT
/// Parts as files: `washer.part.json` says which dimensions a part has, what must hold between them, and how it is drawn.
///     {
///       "fettle_part": 1,
///       "about": "a flat ring",
///       "units": "mm",
///       "dimensions": {
///         "bore": {"value": 5, "about": "radius of the hole"},
///         "wall": {"value": 2, "about": "width of the ring"},
///         "height": {"value": 1, "about": "from face to face"}
///       },
///       "profiles": {"ring": {"holes": [{"circle": "= bore", "name": "bore"}], "in": {"circle": "= bore + wall", "name": "rim"}}},
///       "solid": {"extrude": "ring", "to": "= height"}
///     }
/// Numbers: part_numbers.hpp; shapes: profile_reader.hpp, solid_reader.hpp; relations: part_relation.hpp; every key: part.schema.json. What
/// draws is the part kernel (core/parts): the mesh and its exact derivative with respect to every dimension.
///
/// A file may be anybody's: its demands are bounded (depth, copies, facets), and more than that ends in an error.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/limits.hpp"
#include "core/base/units.hpp"
#include "core/part_files/part_relation.hpp"
#include "core/parts/drawn_part.hpp"

namespace fettle::core::part_files {

enum class PartDimensionKind {
    length,      ///< above 0
    coordinate,  ///< a length of any sign
    angle,
    number
};
const char* name_of(PartDimensionKind kind);
/// Which quantity it is.
base::Dimension dimension_of(PartDimensionKind kind);

struct PartDimension {
    std::string name;
    double value = 0;  ///< if no other is given; SI
    PartDimensionKind kind = PartDimensionKind::length;
    std::string about;
};

/// How many there are of something: it makes the connectivity, so it is no dimension and has no derivative.
struct PartCount {
    std::string name;
    int value = 0;
    int least = 0, most = base::most_copies;
    std::string about;
};

/// Segments of a circle that may be asked for.
inline constexpr int fewest_circle_segments = 8, most_circle_segments = 720;

/// What a scene says besides the dimensions.
using Counts = std::map<std::string, int>;

class PartFile {
public:
    /// Errors: file_not_found, file_unreadable, parse, and every fault of what the file says, with file and JSON pointer; counts that the
    /// part does not have, or that are out of their range ("counts/slots"). @param counts  Those left out are as in the file.
    static Result<PartFile> read(const std::string& path, const Counts& counts = {});
    /// `name` takes the file's place in messages.
    static Result<PartFile> parse(const std::string& text, const std::string& name, const Counts& counts = {});

    /// The file's, without folder and ".part.json".
    const std::string& name() const;
    const std::string& about() const;
    /// In the order of the file.
    const std::vector<PartDimension>& dimensions() const;
    const std::vector<PartCount>& counts() const;  ///< `value`: as given
    const std::vector<PartRelation>& relations() const;
    const parts::Facets& facets() const;  ///< where who draws says nothing else

    /// What is wrong with these values, one for each dimension [SI]: not finite, not above 0, relations. `where`: the part's name and the
    /// dimension ("washer/bore"), or the relation's place.
    Errors faults(const std::vector<double>& values) const;

    /// The part at these values. Errors: faults(), faults of drawing, with the place of what could not be drawn, a mesh that is no solid.
    /// A pure function; may be called from several threads.
    /// @param facets  facets() if not given.
    Result<parts::DrawnPart> drawn(const std::vector<double>& values, const std::optional<parts::Facets>& facets = {},
                                   const parts::Structure& structure = {}, const parts::DrawnOptions& options = {}) const;

    /// The file's `profiles`, by name.
    std::vector<std::string> profile_names() const;
    /// Draws one of them at these values and hands it to `use`: its numbers live no longer than the call.
    /// Errors: faults(), those of drawing. Contract: a name of profile_names().
    Errors with_profile(const std::string& name, const std::vector<double>& values,
                        const std::function<void(const parts::Profile&)>& use) const;

private:
    struct Contents;
    explicit PartFile(std::shared_ptr<const Contents> contents) : contents_(std::move(contents)) {}

    std::shared_ptr<const Contents> contents_;
};

/// The file name's end.
inline constexpr std::string_view part_file_ending = ".part.json";

}  // namespace fettle::core::part_files
