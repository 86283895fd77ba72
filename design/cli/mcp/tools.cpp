// SPDX-License-Identifier: MIT
#include "design/cli/mcp/tools.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

#include "core/files/nearest_word.hpp"
#include "design/cli/named_files.hpp"

namespace fettle::design::cli::mcp {

namespace {

constexpr double usual_wait = 60, longest_wait = 600;  // s
constexpr const char* wait_key = "wait_seconds";

Json property(const char* type, const std::string& description) { return {{"type", type}, {"description", description}}; }

Json own_properties(const std::string& tool) {
    if (tool == "describe")
        return {{"kind",
                 {{"type", "string"},
                  {"enum", {"shapes", "joints", "quantities", "optimisers", "starters", "file", "answer"}},
                  {"description",
                   "What there is to use (with `name`: one of them, with all its keys and dimensions); starters: mechanisms to begin from; "
                   "file: "
                   "the text of a file; answer: a part of an earlier tool's answer that was too long"}}},
                {"name", property("string", "One thing of that kind; the path of the file; the number of the answer (\"answer-3\")")},
                {"pointer", property("string", "Of an answer: which part, as a JSON pointer: /pairs")},
                {"from", property("integer", "Of a list, or of a text's characters: the first that is wanted (default 0)")},
                {"count", property("integer", "How many (default 20 of a list, 20000 characters)")}};
    if (tool == "write")
        return {{"path", property("string", "Scene, design, part or process to write; folders are made")},
                {"text", property("string", "All of the file's text. Validate it afterwards")},
                {"starter",
                 property("string", "Instead of a text: a mechanism to begin from (describe, kind starters); `path` is then the folder")},
                {"replace", property("boolean", "May a file that is there be replaced? (default: no)")}};
    return {{"job", property("string", "As a tool that took long has named it: \"job-2\"")},
            {"action",
             {{"type", "string"},
              {"enum", {"wait", "stop"}},
              {"description", "wait (default): for its answer, `wait_seconds` at most; stop: ask it to end with what it has, then wait"}}}};
}

std::vector<std::string> own_required(const std::string& tool) {
    if (tool == "describe") return {"kind"};
    if (tool == "write") return {"path"};
    return {"job"};
}

// "--allow-touch" is `allow_touch`, "FILE" is `file`.
std::string key_of(const OptionFacts& option) {
    std::string key = option.names.front();
    for (const std::string& name : option.names)
        if (name.starts_with("--")) {
            key = name.substr(2);
            break;
        }
    for (char& c : key) c = c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return key;
}

Json schema_of(const OptionFacts& option) {
    if (option.value.empty()) return property("boolean", option.description);
    Json one = {{"type", option.value == "INT" ? "integer" : option.value == "FLOAT" ? "number" : "string"}};
    if (!option.words.empty() && !option.other_values) one["enum"] = option.words;
    if (option.several) return {{"type", "array"}, {"items", one}, {"description", option.description}};
    one["description"] = option.description;
    return one;
}

const CommandFacts* find_command(const CommandFacts& program, const std::string& name) {
    const auto found =
        std::find_if(program.commands.begin(), program.commands.end(), [&](const CommandFacts& each) { return each.name == name; });
    return found == program.commands.end() ? nullptr : &*found;
}

// Those of the command that the tool offers, in its order.
std::vector<const OptionFacts*> offered(const Tool& tool, const CommandFacts& program) {
    std::vector<const OptionFacts*> out;
    const CommandFacts* command = find_command(program, tool.command);
    if (command == nullptr) return out;
    for (const char* name : tool.options)
        for (const OptionFacts& option : command->options)
            if (std::find(option.names.begin(), option.names.end(), name) != option.names.end()) out.push_back(&option);
    return out;
}

bool is_required(const Tool& tool, const OptionFacts& option) {
    return option.required || std::any_of(tool.needed.begin(), tool.needed.end(), [&](const char* name) {
               return std::find(option.names.begin(), option.names.end(), name) != option.names.end();
           });
}

Json input_schema(const Tool& tool, const CommandFacts& program) {
    Json properties = Json::object();
    std::vector<std::string> required;
    if (*tool.command == '\0') {
        properties = own_properties(tool.name);
        required = own_required(tool.name);
    }
    for (const OptionFacts* option : offered(tool, program)) {
        properties[key_of(*option)] = schema_of(*option);
        if (is_required(tool, *option)) required.push_back(key_of(*option));
    }
    properties[wait_key] = {{"type", "number"},
                            {"minimum", 0},
                            {"maximum", longest_wait},
                            {"description", "What takes longer goes on as a job, which the tool `job` waits for (default 60)"}};
    return {{"type", "object"}, {"properties", properties}, {"required", required}, {"additionalProperties", false}};
}

// As `structuredContent` has it: mcp/answer.hpp.
Json output_schema() {
    return {{"type", "object"},
            {"properties",
             {{"verdict",
               {{"type", "string"}, {"enum", {"proven", "met", "in doubt", "violated", "undecided", "not checked", "refused", "running"}}}},
              {"sentence", property("string", "The verdict in words")},
              {"command", property("string", "What a person would type")},
              {"job", property("string", "Of what goes on")},
              {"answer", {{"description", "SI units unless a key says otherwise"}}},
              {"left_off", property("string", "What of the answer is not here, and how to get it")}}},
            {"required", {"verdict", "sentence"}}};
}

// One value as the command line has it; nothing: it is of another type.
std::optional<std::string> text_of(const Json& value, const OptionFacts& option) {
    if (option.value == "INT" && value.is_number_integer()) return value.dump();
    if (option.value == "FLOAT" && value.is_number()) return value.dump();
    if (option.value != "INT" && option.value != "FLOAT" && value.is_string()) return value.get<std::string>();
    return std::nullopt;
}

std::string type_of(const OptionFacts& option) {
    const Json schema = schema_of(option);
    const std::string type = schema["type"].get<std::string>();
    return type == "array" ? "a list" : type == "integer" ? "a whole number" : type == "boolean" ? "true or false" : "a " + type;
}

class Words {
public:
    Words(const Tool& tool, const CommandFacts& program, const Roots& roots)
        : tool_(tool), command_(tool.command), options_(offered(tool, program)), roots_(roots) {}

    Result<std::vector<std::string>> of(const Json& arguments) {
        words_ = {command_};
        for (const auto& [key, value] : arguments.items()) {
            if (key == wait_key || value.is_null()) continue;
            const OptionFacts* option = find(key);
            if (option != nullptr) add(key, value, *option);
        }
        for (const OptionFacts* option : options_)
            if (is_required(tool_, *option) && !arguments.contains(key_of(*option)))
                errors_.push_back({ErrorCode::missing_key, key_of(*option), "is missing: " + option->description});
        words_.insert(words_.end(), places_.begin(), places_.end());
        if (!errors_.empty()) return errors_;
        return words_;
    }

private:
    const OptionFacts* find(const std::string& key) {
        std::vector<std::string> keys;
        for (const OptionFacts* option : options_) {
            if (key_of(*option) == key) return option;
            keys.push_back(key_of(*option));
        }
        const auto meant = core::files::nearest_word(key, {keys.begin(), keys.end()});
        errors_.push_back({ErrorCode::unknown_key, key, "there is no such argument" + (meant ? "; did you mean `" + *meant + "`?" : "")});
        return nullptr;
    }

    void add(const std::string& key, const Json& value, const OptionFacts& option) {
        if (option.value.empty()) {
            if (!value.is_boolean()) return wrong_type(key, value, option);
            if (value.get<bool>()) words_.push_back(option.names.back());
            return;
        }
        const Json values = option.several && value.is_array() ? value : Json::array({value});
        for (const Json& each : values) {
            const std::optional<std::string> text = text_of(each, option);
            if (!text) return wrong_type(key, value, option);
            add_text(key, *text, option);
        }
    }

    // A value never passes for an option: it stands after "=", or is a path from the root on.
    void add_text(const std::string& key, std::string text, const OptionFacts& option) {
        const bool is_file = !named_files_of(command_, {{option.names.back(), text, option.by_place}}).empty();
        if (is_file || text.find('/') != std::string::npos) {
            Result<std::string> path = roots_.inside(text, key);
            if (!path) {
                errors_.insert(errors_.end(), path.errors().begin(), path.errors().end());
                return;
            }
            text = *std::move(path);
        }
        if (option.by_place) {
            places_.push_back(std::move(text));
        } else {
            words_.push_back(option.names.back() + "=" + text);
        }
    }

    void wrong_type(const std::string& key, const Json& value, const OptionFacts& option) {
        errors_.push_back({ErrorCode::wrong_type, key, type_of(option) + " is expected, found " + value.dump().substr(0, 60)});
    }

    const Tool& tool_;
    std::string command_;
    std::vector<const OptionFacts*> options_;
    const Roots& roots_;
    std::vector<std::string> words_, places_;
    Errors errors_;
};

}  // namespace

const std::vector<Tool>& tools() {
    static const std::vector<Tool> all{
        {"describe",
         "What there is to use; a file's text; more of an answer",
         "",
         {},
         "Lists the shapes of the library, joints, quantities, optimisers and starters, one of them in full; reads a file; pages through "
         "an answer.",
         false},
        {"write", "Write a scene, design or part", "", {}, "Writes a text file, or the files of a starter.", true},
        {"validate",
         "Is this file usable?",
         "validate",
         {"FILE", "--unit", "--minimum", "--source"},
         "Seconds. Every fault is told with its place. A certificate is checked without the search that made it.",
         false},
        {"simulate",
         "Simulate",
         "simulate",
         {"SCENE", "--steps", "--time", "--out"},
         "Seconds to minutes. That no two bodies pass through each other is proven; nothing is required of the motion, so see what moved: "
         "a "
         "mechanism that comes apart never collides.",
         true},
        {"clearance",
         "Prove clearances",
         "clearance",
         {"FILE", "--minimum", "--process", "--pairs", "--ignore", "--allow-touch", "--motion", "--kinematic", "--ranges", "--tolerances",
          "--steps", "--time", "--unit", "--split", "--budget", "--certificate", "--out"},
         "Seconds to minutes. Give one of motion, kinematic, ranges, tolerances, or none: as assembled. \"violated\" has a place and an "
         "instant; "
         "\"undecided\" is no pass and no failure. See what was left out.",
         true},
        {"ranges",
         "From where to where is each joint free?",
         "ranges",
         {"FILE", "--joint", "--minimum", "--ignore", "--anywhere"},
         "Seconds.",
         false},
        {"check", "Is every requirement of a design met?", "check", {"DESIGN", "--resolution"}, "Seconds to minutes.", false},
        {"gradient",
         "What does each parameter do?",
         "gradient",
         {"DESIGN", "--check"},
         "Seconds; with check a minute or more. Derivatives of the objective and of each requirement.",
         false},
        {"optimise",
         "Tune a design",
         "optimise",
         {"DESIGN", "--out", "--starts", "--repair", "--optimiser", "--resume"},
         "Minutes. Writes the tuned design into `out`. A design that violates a requirement is told as such: nothing is forced.",
         true,
         {"--out"}},
        {"tolerance",
         "What becomes of it when parts are made",
         "tolerance",
         {"DESIGN", "--samples", "--process", "--worst-case", "--first-order", "--report"},
         "Seconds; with samples or worst_case minutes. Computed, not proven.",
         true},
        {"draw",
         "A picture",
         "draw",
         {"FILE", "--view", "--time", "--worst", "--bodies", "--unit", "--size"},
         "Seconds. The nearest points of two bodies are marked.",
         false},
        {"export",
         "Write parts for printing or other programs",
         "export",
         {"FILE", "--to", "--format", "--arrange", "--bodies", "--unit"},
         "Seconds.",
         true},
        {"job", "Wait for what takes long, or stop it", "", {}, "A job's answer is that of the tool that began it.", false},
    };
    return all;
}

const Tool* find_tool(const std::string& name) {
    const auto found = std::find_if(tools().begin(), tools().end(), [&](const Tool& tool) { return name == tool.name; });
    return found == tools().end() ? nullptr : &*found;
}

Json tool_list(const CommandFacts& program) {
    Json list = Json::array();
    for (const Tool& tool : tools()) {
        const CommandFacts* command = find_command(program, tool.command);
        list.push_back(
            {{"name", tool.name},
             {"title", tool.title},
             {"description", (command != nullptr ? command->description + ". " : "") + tool.about},
             {"inputSchema", input_schema(tool, program)},
             {"outputSchema", output_schema()},
             {"annotations",
              {{"readOnlyHint", !tool.writes}, {"destructiveHint", tool.writes}, {"idempotentHint", true}, {"openWorldHint", false}}}});
    }
    return list;
}

Result<std::vector<std::string>> words_of(const Tool& tool, const CommandFacts& program, const Json& arguments, const Roots& roots) {
    if (!arguments.is_object()) return Error{ErrorCode::wrong_type, "arguments", "an object is expected"};
    return Words(tool, program, roots).of(arguments);
}

Result<double> seconds_to_wait(const Json& arguments) {
    if (!arguments.is_object() || !arguments.contains(wait_key)) return usual_wait;
    const Json& value = arguments[wait_key];
    if (value.is_number() && value.get<double>() >= 0 && value.get<double>() <= longest_wait) return value.get<double>();
    return Error{ErrorCode::out_of_range, wait_key, "a number from 0 to 600 is expected"};
}

}  // namespace fettle::design::cli::mcp
