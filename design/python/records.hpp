// SPDX-License-Identifier: MIT
/// Plain structs of the library as Python dataclasses, and back. A struct has a list of its members here (scene_records.hpp and the like)
/// and a dataclass of the same name and members in the Python package; the two directions follow from the list. So Python owns what it
/// holds: lists can be appended to, objects pickled, and no reference points into a vector that has grown.
/// Enumerators are Python strings. tests/design/python/records_test.py checks that both sides have the same members and defaults.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

namespace fettle::design::python {

template <class Owner, class Member>
struct Field {
    const char* name;
    Member Owner::*member;
};
template <class Owner, class Member>
constexpr Field<Owner, Member> field(const char* name, Member Owner::*member) {
    return {name, member};
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

[[noreturn]] void refuse_type(const char* record, const char* member, pybind11::handle found);

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
        std::apply([&](const auto&... field) { (read(source, field), ...); }, Record::fields);
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
        const object found = source.attr(field.name);
        using Member = std::remove_reference_t<decltype(value.*field.member)>;
        make_caster<Member> member;
        if (!member.load(found, true)) fettle::design::python::refuse_type(Record::python_name, field.name, found);
        value.*field.member = cast_op<Member&&>(std::move(member));
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
        std::string known;
        for (const std::string_view name : names) known += (known.empty() ? "" : ", ") + std::string(name);
        throw value_error("\"" + word + "\" is none of: " + known);
    }

    static handle cast(T source, return_value_policy, handle) {
        const auto i = static_cast<std::size_t>(source);
        if (i >= std::size(names)) throw value_error("an enumerator that the Python package has no word for");
        return str(std::string(names[i])).release();
    }
};

}  // namespace pybind11::detail
