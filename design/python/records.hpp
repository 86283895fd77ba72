// SPDX-License-Identifier: MIT
/// Plain structs of the library as Python dataclasses, and back. A struct has a list of its members here (scene_records.hpp and the like)
/// and a dataclass of the same name and members in the Python package; the two directions follow from the list. So Python owns what it
/// holds: lists can be appended to, objects pickled, and no reference points into a vector that has grown.
/// Enumerators are Python strings; members that are paths are strings or os.PathLike. Members that are NaN, or no word that is known, are
/// refused by record, name and member ("body `cube`/type"). tests/design/python/records_test.py checks that both sides have the same
/// members and defaults.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "design/python/raised_errors.hpp"

namespace fettle::design::python {

template <class Owner, class Member>
struct Field {
    const char* name;
    Member Owner::*member;
    bool is_path = false;
};
template <class Owner, class Member>
constexpr Field<Owner, Member> field(const char* name, Member Owner::*member) {
    return {name, member};
}
/// A text, or a list of texts, that may be given as os.PathLike.
template <class Owner, class Member>
constexpr Field<Owner, Member> path_field(const char* name, Member Owner::*member) {
    return {name, member, true};
}

/// Specialised for each struct: `name` (a description of pybind11's), `python_name`, `fields` (a tuple of Field).
template <class T>
struct Record;
template <class T>
concept IsRecord = requires {
    Record<T>::python_name;
};

/// Specialised for each enum: `names`, one per enumerator, in their order from 0.
template <class T>
struct Words;
template <class T>
concept IsWord = requires {
    Words<T>::names;
};

/// The dataclass of that name.
pybind11::object record_class(const char* name);
/// A list of records as the list that shows itself in few lines (fettle/_record.py).
pybind11::object record_list(pybind11::object list);
/// What a dataclass says of itself before it is read: with names of bodies as their numbers, units checked (`_prepared` in fettle/).
pybind11::object prepared(pybind11::handle record);
/// os.PathLike as text, in lists too; all else as it is.
pybind11::object paths_as_text(pybind11::object given);

/// @param wanted  empty: it is not said what
[[noreturn]] void refuse_type(const char* record, const char* member, pybind11::handle found, const std::string& wanted);
[[noreturn]] void refuse_word(const std::string& word, std::span<const std::string_view> known);
[[noreturn]] void refuse_nan();
/// Throws the errors on, their place given from this record: "body `cube`/type", "parameter `height`/upper".
[[noreturn]] void refuse_member(const Errors& errors, pybind11::handle record, const char* record_name, const char* member);

/// True for numbers, vectors and matrices, and for lists, tables and optional ones of them; false for all else.
template <class T>
bool has_nan(const T& x) {
    if constexpr (std::is_floating_point_v<T>) {
        return std::isnan(x);
    } else if constexpr (std::is_base_of_v<Eigen::DenseBase<T>, T>) {
        return x.hasNaN();
    } else if constexpr (pybind11::detail::is_instantiation<std::optional, T>::value) {
        return x && has_nan(*x);
    } else if constexpr (pybind11::detail::is_instantiation<std::vector, T>::value) {
        return std::any_of(x.begin(), x.end(), [](const auto& each) { return has_nan(each); });
    } else if constexpr (pybind11::detail::is_instantiation<std::map, T>::value) {
        return std::any_of(x.begin(), x.end(), [](const auto& each) { return has_nan(each.second); });
    } else {
        return false;
    }
}

/// What a member takes, for messages; empty where that is many things.
template <class T>
std::string wanted_text() {
    if constexpr (IsRecord<T>) {
        return std::string("a fettle.") + Record<T>::python_name;
    } else if constexpr (std::is_same_v<T, bool>) {
        return "True or False";
    } else if constexpr (std::is_arithmetic_v<T>) {
        return std::is_integral_v<T> ? "a whole number" : "a number";
    } else if constexpr (std::is_same_v<T, std::string> || IsWord<T>) {
        return "a text";
    } else if constexpr (std::is_same_v<T, Vector3>) {
        return "three numbers";
    } else if constexpr (std::is_same_v<T, Matrix3>) {
        return "three rows of three numbers";
    } else if constexpr (pybind11::detail::is_instantiation<std::optional, T>::value) {
        const std::string value = wanted_text<typename T::value_type>();
        return value.empty() ? value : value + ", or None,";
    } else {
        return {};
    }
}

/// True and False are numbers to Python, and hardly meant as such.
template <class T>
constexpr bool is_number() {
    if constexpr (pybind11::detail::is_instantiation<std::optional, T>::value) {
        return is_number<typename T::value_type>();
    } else {
        return std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;
    }
}

/// A member of a Python object, as the library has it.
template <class Member>
Member member_of(pybind11::handle source, const char* record_name, const char* name, bool is_path = false) {
    const pybind11::object given = source.attr(name), found = is_path ? paths_as_text(given) : given;
    pybind11::detail::make_caster<Member> caster;
    try {
        if ((is_number<Member>() && pybind11::isinstance<pybind11::bool_>(found)) || !caster.load(found, true))
            refuse_type(record_name, name, found, wanted_text<Member>());
        Member value = pybind11::detail::cast_op<Member&&>(std::move(caster));
        if (has_nan(value)) refuse_nan();
        return value;
    } catch (const RaisedErrors& raised) {
        refuse_member(raised.errors(), source, record_name, name);
    }
}

}  // namespace fettle::design::python

/// At global scope: FETTLE_RECORD(core::scene::Damping, "Damping", field("linear", &Type::linear), field("angular", &Type::angular))
#define FETTLE_RECORD(TYPE, NAME, ...)                                             \
    template <>                                                                    \
    struct fettle::design::python::Record<TYPE> {                                  \
        using Type = TYPE;                                                         \
        static constexpr auto name = pybind11::detail::const_name("fettle." NAME); \
        static constexpr const char* python_name = NAME;                           \
        static constexpr auto fields = std::make_tuple(__VA_ARGS__);               \
    };

#define FETTLE_WORDS(TYPE, ...)                                    \
    template <>                                                    \
    struct fettle::design::python::Words<TYPE> {                   \
        static constexpr std::string_view names[] = {__VA_ARGS__}; \
    };

namespace pybind11::detail {

template <class T>
requires fettle::design::python::IsRecord<T>
class type_caster<T> {
    using Record = fettle::design::python::Record<T>;

public:
    PYBIND11_TYPE_CASTER(T, Record::name);

    bool load(handle source, bool) {
        if (!isinstance(source, fettle::design::python::record_class(Record::python_name))) return false;
        const object whole = fettle::design::python::prepared(source);
        std::apply([&](const auto&... field) { (read(whole, field), ...); }, Record::fields);
        return true;
    }

    template <class Source>
    static handle cast(Source&& source, return_value_policy, handle) {
        dict members;
        std::apply([&](const auto&... field) { ((members[field.name] = pybind11::cast(source.*field.member)), ...); }, Record::fields);
        return fettle::design::python::record_class(Record::python_name)(**members).release();
    }

private:
    template <class Field>
    void read(handle source, const Field& field) {
        using Member = std::remove_reference_t<decltype(value.*field.member)>;
        value.*field.member = fettle::design::python::member_of<Member>(source, Record::python_name, field.name, field.is_path);
    }
};

template <class T>
requires fettle::design::python::IsRecord<T>
class type_caster<std::vector<T>> : public list_caster<std::vector<T>, T> {
public:
    template <class Source>
    static handle cast(Source&& source, return_value_policy policy, handle parent) {
        const handle list = list_caster<std::vector<T>, T>::cast(std::forward<Source>(source), policy, parent);
        return fettle::design::python::record_list(reinterpret_steal<object>(list)).release();
    }
};

template <class T>
requires fettle::design::python::IsWord<T>
class type_caster<T> {
    static constexpr auto& names = fettle::design::python::Words<T>::names;

public:
    PYBIND11_TYPE_CASTER(T, const_name("str"));

    bool load(handle source, bool) {
        if (!isinstance<str>(source)) return false;
        const auto word = source.cast<std::string>();
        for (std::size_t i = 0; i < std::size(names); ++i) {
            if (names[i] != word) continue;
            value = static_cast<T>(i);
            return true;
        }
        fettle::design::python::refuse_word(word, names);
    }

    static handle cast(T source, return_value_policy, handle) {
        const auto i = static_cast<std::size_t>(source);
        if (i >= std::size(names)) throw value_error("an enumerator that the Python package has no word for");
        return str(std::string(names[i])).release();
    }
};

}  // namespace pybind11::detail
