// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/limits.hpp"
#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "core/files/json_document.hpp"
#include "core/files/text_lines.hpp"
#include "core/records/poses_table.hpp"

namespace fettle::core::records {
namespace {

using base::ErrorCode;

constexpr std::size_t max_errors = 20;  // a column that is wrong is wrong in every row
constexpr double degree = M_PI / 180;

const std::array<std::vector<std::string>, 3> rotation_columns{
    {{"qw", "qx", "qy", "qz"}, {"rx", "ry", "rz"}, {"r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"}}};
const std::vector<std::string> position_columns{"px", "py", "pz"};

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r";
    const auto first = text.find_first_not_of(blanks);
    return first == std::string_view::npos ? std::string_view{} : text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

// Fields between commas; a field in double quotes may hold commas, and quotes written twice.
std::vector<std::string> fields_of(std::string_view line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
            fields.back() += line[++i];
        } else if (c == '"') {
            quoted = !quoted;
        } else if (c == ',' && !quoted) {
            fields.emplace_back();
        } else {
            fields.back() += c;
        }
    }
    for (std::string& field : fields) field = trimmed(field);
    return fields;
}

struct Column {
    std::string name, unit;  // "px[mm]"
};

Column column_of(const std::string& field) {
    const auto open = field.find('[');
    if (open == std::string::npos || field.back() != ']') return {field, ""};
    return {std::string(trimmed(std::string_view(field).substr(0, open))), field.substr(open + 1, field.size() - open - 2)};
}

class CsvReader {
public:
    CsvReader(std::string_view text, std::string name, const model::Model& model, std::optional<double> unit)
        : rest_(text), name_(std::move(name)), model_(model), unit_(unit) {
        if (rest_.substr(0, 3) == "\xEF\xBB\xBF") rest_.remove_prefix(3);
    }

    base::Result<PosesTable> read() {
        if (!next_row())
            return base::Error{ErrorCode::parse, name_,
                               "the file is empty; a header row is expected, such as time,body,px[mm],py[mm],pz[mm],qw,qx,qy,qz"};
        read_header();
        if (!errors_.empty()) return errors_;
        while (next_row() && errors_.size() < max_errors) read_row();
        if (errors_.size() >= max_errors) fail(ErrorCode::parse, "too many faults; what follows was not read");
        if (errors_.empty() && table_.times.empty()) fail(ErrorCode::parse, "no row of poses follows the header");
        const bool rows_good = errors_.empty();
        for (std::size_t t = 1; rows_good && t < table_.times.size(); ++t) check_complete(t);
        if (!errors_.empty()) return errors_;
        return std::move(table_);
    }

private:
    std::string where() const { return name_ + ":" + std::to_string(line_); }
    void fail(ErrorCode code, std::string message) { errors_.push_back({code, where(), std::move(message)}); }

    bool next_row() {
        while (!rest_.empty()) {
            const std::size_t length = std::min(rest_.find('\n'), rest_.size());
            const std::string_view line = trimmed(rest_.substr(0, length));
            rest_.remove_prefix(std::min(length + 1, rest_.size()));
            ++line_;
            if (line.empty() || line.front() == '#') continue;
            row_ = fields_of(line);
            return true;
        }
        return false;
    }

    void read_header() {
        for (const std::string& field : row_) columns_.push_back(column_of(field));
        if (columns_.size() == 1 && row_[0].find_first_of(";\t") != std::string::npos) {
            fail(ErrorCode::parse, "the columns are not separated by commas");
            return;
        }
        time_ = find("time");
        body_ = find("body");
        for (const auto& name : position_columns) position_.push_back(find(name));
        find_rotation();
        if (!columns_[time_].unit.empty() && columns_[time_].unit != "s") fail(ErrorCode::unsupported, "times are in seconds: time[s]");
        if (errors_.empty()) find_length_unit();
        for (std::size_t i = 0; i < columns_.size() && errors_.empty(); ++i) {
            if (std::find(known_.begin(), known_.end(), columns_[i].name) == known_.end())
                fail(ErrorCode::unknown_key, "column \"" + columns_[i].name +
                                                 "\" is not known; known: time, body, px, py, pz and one of qw qx qy "
                                                 "qz, rx ry rz, r11 .. r33");
        }
    }

    // Index of a column; 0 and a fault if it is missing or there twice.
    std::size_t find(const std::string& name) {
        const auto named = [&](const Column& c) { return c.name == name; };
        known_.push_back(name);
        const auto count = std::count_if(columns_.begin(), columns_.end(), named);
        if (count == 1) return static_cast<std::size_t>(std::find_if(columns_.begin(), columns_.end(), named) - columns_.begin());
        fail(count ? ErrorCode::inconsistent : ErrorCode::missing_key, "column \"" + name + "\" is " + (count ? "there twice" : "missing") +
                                                                           "; expected: time,body,px[mm],py[mm],pz[mm],qw,qx,qy,qz");
        return 0;
    }

    void find_rotation() {
        std::vector<int> given;
        for (int form = 0; form < 3; ++form) {
            const auto& names = rotation_columns[form];
            if (std::any_of(columns_.begin(), columns_.end(), [&](const Column& c) { return c.name == names.front(); }))
                given.push_back(form);
        }
        if (given.size() != 1) {
            fail(given.empty() ? ErrorCode::missing_key : ErrorCode::inconsistent,
                 std::string(given.empty() ? "no rotation" : "more than one rotation") +
                     "; one of qw qx qy qz, rx ry rz, r11 .. r33 is expected");
            return;
        }
        form_ = static_cast<RotationForm>(given[0]);
        for (const auto& name : rotation_columns[given[0]]) rotation_.push_back(find(name));
        for (const std::size_t i : rotation_) {
            const std::string& unit = columns_[i].unit;
            const bool angle = form_ == RotationForm::rotation_vector;
            if (!(unit.empty() || (angle && (unit == "rad" || unit == "deg"))))
                fail(ErrorCode::out_of_range,
                     "unit \"" + unit + "\" of column " + columns_[i].name + (angle ? ": rad or deg" : ": it has none"));
            angle_scale_.push_back(unit == "deg" ? degree : 1);
        }
    }

    void find_length_unit() {
        const std::string& name = columns_[position_[0]].unit;
        for (const std::size_t i : position_) {
            if (columns_[i].unit != name) fail(ErrorCode::inconsistent, "px, py and pz are in one unit: px[mm],py[mm],pz[mm]");
        }
        if (!errors_.empty()) return;
        if (name.empty() && !unit_) {
            fail(ErrorCode::missing_key, "the unit of px, py and pz is not said; write px[mm],py[mm],pz[mm] or say --poses-unit mm");
            return;
        }
        if (name.empty()) return;
        const auto metres = base::metres_per_unit(name, where());
        if (!metres) {
            errors_.insert(errors_.end(), metres.errors().begin(), metres.errors().end());
        } else if (unit_ && *unit_ != *metres) {
            fail(ErrorCode::inconsistent, "px is in " + name + " here, and in another unit by --poses-unit; leave one of them out");
        } else {
            unit_ = *metres;
        }
    }

    std::optional<double> number(std::size_t column) {
        const auto value = files::parsed_number(row_[column]);
        if (value && base::is_usable_number(*value)) return value;
        if (value && std::isfinite(*value)) {
            fail(ErrorCode::out_of_range,
                 "column " + columns_[column].name + ": " + row_[column] + " is out of range: at most 1e30 in absolute value is allowed");
            return std::nullopt;
        }
        fail(value ? ErrorCode::not_finite : ErrorCode::parse,
             "column " + columns_[column].name + ": \"" + row_[column] + "\" is not a " + (value ? "finite " : "") + "number");
        return std::nullopt;
    }

    void read_row() {
        if (row_.size() != columns_.size()) {
            fail(ErrorCode::parse, std::to_string(row_.size()) + " fields, the header has " + std::to_string(columns_.size()) + " columns");
            return;
        }
        const auto time = number(time_);
        const auto body = body_by_name(model_, base::csv_word(row_[body_]), where(), errors_);
        kinematics::Pose pose;
        bool good = true;
        for (int k = 0; k < 3; ++k) {
            const auto x = number(position_[k]);
            good = good && x;
            pose.position[k] = files::in_metres(x.value_or(0), unit_.value_or(1));
        }
        std::vector<double> numbers;
        for (std::size_t k = 0; k < rotation_.size(); ++k) {
            const auto x = number(rotation_[k]);
            good = good && x;
            numbers.push_back(angle_scale_[k] * x.value_or(0));
        }
        if (!good || !time || !body) return;
        const auto rotation = rotation_from_numbers(form_, numbers, where(), table_, errors_);
        if (!rotation) return;
        pose.rotation = *rotation;
        store(*time, *body, pose);
    }

    void store(double time, int body, const kinematics::Pose& pose) {
        if (table_.times.empty() || table_.times.back() != time) {
            if (!table_.times.empty() && time < table_.times.back()) {
                fail(ErrorCode::inconsistent,
                     "time " + row_[time_] + " comes after a later one; rows are in order of time, those of one time together");
                return;
            }
            table_.times.push_back(time);
            table_.time_where.push_back(where());
            table_.entries.emplace_back(model_.bodies.size());
        }
        auto& entry = table_.entries.back()[body];
        if (entry)
            fail(ErrorCode::inconsistent,
                 "body \"" + row_[body_] + "\" is there twice at time " + row_[time_] + ", first in " + entry->where);
        entry = PoseEntry{pose, where()};
    }

    // A body that is named once is named always: where it was in between nobody knows.
    void check_complete(std::size_t t) {
        for (std::size_t b = 0; b < model_.bodies.size() && errors_.size() < max_errors; ++b) {
            const auto& first = table_.entries.front();
            if (first[b].has_value() != table_.entries[t][b].has_value()) {
                errors_.push_back({ErrorCode::inconsistent, table_.time_where[t],
                                   "body \"" + model_.bodies[b].name + "\" is " + (first[b] ? "missing at this time" : "new at this time") +
                                       "; a body is at all times or at none"});
            }
        }
    }

    std::string_view rest_;
    std::string name_;
    const model::Model& model_;
    std::optional<double> unit_;
    int line_ = 0;
    std::vector<std::string> row_;
    std::vector<Column> columns_;
    std::vector<std::string> known_;  // names of the columns that mean something
    std::size_t time_ = 0, body_ = 0;
    std::vector<std::size_t> position_, rotation_;
    std::vector<double> angle_scale_;
    RotationForm form_ = RotationForm::quaternion;
    PosesTable table_;
    base::Errors errors_;
};

}  // namespace

base::Result<PosesTable> read_poses_csv(std::string_view text, const std::string& name, const model::Model& model,
                                        std::optional<double> length_unit) {
    return CsvReader(text, name, model, length_unit).read();
}

}  // namespace fettle::core::records
