// SPDX-License-Identifier: Apache-2.0
//
// Tests as JSON, its schema, and the twin in text. docs/vectors.md describes both.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include "certify/vectors/vectors.hpp"
#include "corpus/draw_fields.hpp"

namespace surefill::vectors {
namespace {

// ---- values
std::string hex(float value) {
  return fmt::format("{:08x}", std::bit_cast<std::uint32_t>(value));
}

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c == '\n' || c == '\t' ? ' ' : c;
  }
  return result + '"';
}

std::string underlined(std::string_view text) {
  std::string result(text);
  std::replace(result.begin(), result.end(), '-', '_');
  return result;
}

template <typename Range, typename Write>
std::string joined(const Range& range, const char* between, const Write& write) {
  std::string result;
  bool first = true;
  for (const auto& element : range) {
    if (!first) result += between;
    result += write(element), first = false;
  }
  return result;
}

std::string list(const std::set<std::string>& words) {
  return "[" + joined(words, ", ", [](const std::string& word) { return quoted(word); }) + "]";
}

// A decimal that is read back to the same bits; NaN and infinities as words.
std::string decimal(float value) {
  if (std::isnan(value)) return "\"nan\"";
  if (std::isinf(value)) return value > 0 ? "\"inf\"" : "\"-inf\"";
  if (value == 0) return std::signbit(value) ? "-0.0" : "0";
  return fmt::format("{:.9g}", value) == fmt::format("{}", value) ? fmt::format("{:.9g}", value)
                                                                  : fmt::format("{}", value);
}

// ---- planes
// One value a sample, as it is written; what is the same in a row is written once.
struct Plane {
  std::string name;  // "count", "open", "index", "depth", "b0", ...
  std::vector<std::string> values;
};

std::string runs(const std::vector<std::string>& values, const char* between, bool counted) {
  std::string result;
  std::size_t number = 0;
  for (std::size_t i = 0; i < values.size();) {
    std::size_t end = i;
    while (end < values.size() && values[end] == values[i]) ++end;
    if (number++ > 0) result += between;
    result += fmt::format("{}{}{}", end - i, between, values[i]);
    i = end;
  }
  return counted ? fmt::format("{}{}{}", number, between, result) : result;
}

// The planes of a frame. `high`: of intervals, their ends; else their beginnings. In JSON an interval is one text.
std::vector<Plane> planes_of(const Test& test, const VectorFrame& frame, bool json, bool high) {
  const std::vector<std::size_t> samples = test.samples();
  const Expected& e = frame.expected;
  std::vector<Plane> planes;
  const std::vector<std::size_t> layered = test.samples(true);
  const auto whole = [&](const char* name, const auto& values, const std::vector<std::size_t>& at) {
    Plane& plane = planes.emplace_back();
    plane.name = name;
    for (const std::size_t s : at) plane.values.push_back(std::to_string(values[s]));
  };
  const auto real = [&](const std::string& name, const std::vector<float>& values, const std::vector<float>& ends,
                        std::size_t elements, std::size_t element) {
    Plane& plane = planes.emplace_back();
    plane.name = name;
    for (const std::size_t s : layered) {
      const std::size_t at = s * elements + element;
      const std::string value = hex(high && !ends.empty() ? ends[at] : values[at]);
      plane.values.push_back(!json ? value : ends.empty() ? quoted(value) : quoted(value + ":" + hex(ends[at])));
    }
  };
  if (test.outputs.count && !high) whole("count", e.count, samples);
  if (test.outputs.count && high) {
    std::vector<std::uint32_t> most = e.count;
    for (std::size_t s = 0; s < e.open.size(); ++s) most[s] += e.open[s];
    whole("count", most, samples);
  }
  if (!e.index.empty()) whole("index", e.index, layered);
  if (test.outputs.depth) real("depth", e.depth, e.depth_high, 1, 0);
  for (std::size_t i = 0; test.outputs.barycentrics && i < 3; ++i)
    real("b" + std::to_string(i), e.barycentrics, e.barycentrics_high, 3, i);
  for (std::size_t k = 0; test.outputs.attributes && k < frame.scene.attributes.size(); ++k) {
    static const std::vector<float> none;
    const corpus::SceneAttribute& attribute = frame.scene.attributes[k];
    for (std::size_t c = 0; c < attribute.components; ++c)
      real(fmt::format("a{}.{}", k, c), e.attributes[k], e.attributes_high.empty() ? none : e.attributes_high[k],
           attribute.components, c);
  }
  if (!e.winding.empty()) whole("winding", e.winding, samples);
  return planes;
}

// ---- state
// Calls write(name, value) for each field that version 1 of the files has, in its order; a structure as its parts.
template <typename Write>
void for_each_field(const DrawState& state, const Write& write) {
  corpus::for_each_draw_field([&](const auto& field) {
    static constexpr std::array<std::string_view, 10> kFields{"fill-rule",   "front-face",   "cull",    "depth-mode",
                                                              "depth-write", "conservative", "scissor", "grid",
                                                              "culling-box", "depth-bias"};
    if (std::find(kFields.begin(), kFields.end(), field.name) != kFields.end()) write(field.name, state.*field.member);
  });
}

template <typename Enum>
std::string word(Enum value) {
  return underlined(corpus::names_of<Enum>()[static_cast<std::size_t>(value)].second);
}

std::string state_json(const DrawState& state) {
  std::string result = "{";
  for_each_field(state, [&result](std::string_view name, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    std::string text;
    if constexpr (std::is_same_v<Value, bool>) {
      text = value ? "true" : "false";
    } else if constexpr (std::is_enum_v<Value>) {
      text = quoted(word(value));
    } else if constexpr (corpus::kIsOptional<Value>) {
      if (!value) return;
      std::vector<std::string> parts;
      corpus::for_each_part(*value, [&parts](const auto& part, const auto&...) {
        using Part = std::decay_t<decltype(part)>;
        if constexpr (std::is_enum_v<Part>) {
          parts.push_back(quoted(word(part)));
        } else if constexpr (std::is_same_v<Part, float>) {
          parts.push_back(quoted(hex(part)));
        } else {
          parts.push_back(std::to_string(part));
        }
      });
      text = "[" + joined(parts, ", ", std::identity()) + "]";
    }
    if (text.empty()) return;
    result += (result.size() > 1 ? ", " : "") + quoted(underlined(name)) + ": " + text;
  });
  return result + "}";
}

std::string state_text(const DrawState& state) {
  std::string result;
  for_each_field(state, [&result](std::string_view, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (corpus::kIsOptional<Value>) {
      result += value ? " 1" : " 0";
      if (!value) return;
      corpus::for_each_part(*value, [&result](const auto& part, const auto&...) {
        using Part = std::decay_t<decltype(part)>;
        if constexpr (std::is_same_v<Part, float>) {
          result += " " + hex(part);
        } else {
          result += fmt::format(" {}", static_cast<int>(part));
        }
      });
    } else {
      if constexpr (std::is_enum_v<Value> || std::is_same_v<Value, bool>)
        result += fmt::format(" {}", static_cast<int>(value));
    }
  });
  return result.substr(1);
}

bool has_identifiers(const corpus::SceneDraw& draw) {
  return !draw.triangles.empty() && draw.triangles[0].identifier.has_value();
}

// ---- JSON
std::string draw_json(const corpus::Scene& scene, const corpus::SceneDraw& draw) {
  std::string text = "{\"state\": " + state_json(draw) + ",\n";
  const auto vertices = [&](const auto& write) {
    return joined(draw.vertices, ", ", [&](const corpus::SceneVertex& v) {
      return "[" + joined(std::array<float, 4>{v.x, v.y, v.z, v.w}, ", ", write) + "]";
    });
  };
  text += "       \"vertices\": {\"bits\": [" + vertices([](float f) { return quoted(hex(f)); }) + "],\n";
  text += "                    \"decimal\": [" + vertices(decimal) + "]},\n";
  text += "       \"triangles\": [" +
          joined(draw.triangles, ", ",
                 [](const corpus::SceneTriangle& t) {
                   return fmt::format("[{}, {}, {}]", t.vertices[0], t.vertices[1], t.vertices[2]);
                 }) +
          "]";
  if (has_identifiers(draw)) {
    text += ",\n       \"identifiers\": [" +
            joined(draw.triangles, ", ", [](const corpus::SceneTriangle& t) { return std::to_string(*t.identifier); }) +
            "]";
  } else {
    text += fmt::format(", \"first_index\": {}", *draw.first_index);
  }
  std::size_t offset = 0;
  for (std::size_t k = 0; k < scene.attributes.size(); ++k) {
    const corpus::SceneAttribute& attribute = scene.attributes[k];
    text += k == 0 ? ",\n       \"attributes\": [" : ",\n         ";
    text += fmt::format("{{\"interpolation\": \"{}\", \"bits\": [",
                        corpus::kInterpolationNames[static_cast<std::size_t>(attribute.interpolation)].second);
    text += joined(draw.vertices, ", ", [&](const corpus::SceneVertex& v) {
      return "[" +
             joined(std::span(v.attributes).subspan(offset, attribute.components), ", ",
                    [](float f) { return quoted(hex(f)); }) +
             "]";
    });
    text += k + 1 == scene.attributes.size() ? "]}]" : "]}";
    offset += attribute.components;
  }
  return text + "}";
}

std::string expected_json(const Test& test, const VectorFrame& frame) {
  const std::vector<Plane> planes = planes_of(test, frame, true, false);
  const auto plane = [&](std::string_view name) {
    const auto found = std::find_if(planes.begin(), planes.end(), [&](const Plane& p) { return p.name == name; });
    return "[" + runs(found->values, ", ", false) + "]";
  };
  std::vector<std::string> members;
  if (test.outputs.count) members.push_back("\"count\": " + plane("count"));
  if (test.outputs.count &&
      std::any_of(frame.expected.open.begin(), frame.expected.open.end(), [](std::uint32_t o) { return o != 0; })) {
    std::vector<std::string> open;
    for (const std::size_t s : test.samples()) open.push_back(std::to_string(frame.expected.open[s]));
    members.push_back("\"open\": [" + runs(open, ", ", false) + "]");
  }
  if (!frame.expected.index.empty()) members.push_back("\"index\": " + plane("index"));
  if (test.outputs.depth) members.push_back("\"depth\": " + plane("depth"));
  if (test.outputs.barycentrics)
    members.push_back("\"barycentrics\": [" + plane("b0") + ", " + plane("b1") + ", " + plane("b2") + "]");
  if (test.outputs.attributes) {
    std::string text = "\"attributes\": [";
    for (std::size_t k = 0; k < frame.scene.attributes.size(); ++k) {
      text += k == 0 ? "[" : ", [";
      for (std::uint32_t c = 0; c < frame.scene.attributes[k].components; ++c)
        text += (c == 0 ? "" : ", ") + plane(fmt::format("a{}.{}", k, c));
      text += "]";
    }
    members.push_back(text + "]");
  }
  if (!frame.expected.winding.empty()) members.push_back("\"winding\": " + plane("winding"));
  return "{" + joined(members, ",\n                  ", std::identity()) + "}";
}

std::string frame_json(const Test& test, const VectorFrame& frame) {
  std::string text = "{";
  if (frame.previous) {
    text += "\"initial_depth\": \"previous\",\n      ";
  } else if (!frame.scene.initial_depth.empty()) {
    std::vector<std::string> values;
    const std::size_t total = static_cast<std::size_t>(frame.scene.width) *
                              static_cast<std::size_t>(frame.scene.height) *
                              static_cast<std::size_t>(frame.scene.samples);
    for (std::size_t s = 0; s < total; ++s)
      values.push_back(quoted(hex(frame.scene.initial_depth[frame.scene.initial_depth.size() == 1 ? 0 : s])));
    text += "\"initial_depth\": [" + runs(values, ", ", false) + "],\n      ";
  }
  text += "\"draws\": [" +
          joined(frame.scene.draws, ",\n      ",
                 [&](const corpus::SceneDraw& draw) { return draw_json(frame.scene, draw); }) +
          "],\n";
  return text + "      \"expected\": " + expected_json(test, frame) + "}";
}

// Numbers of the outputs that are asked for: 1 count, 2 index, 4 depth, 8 barycentrics, 16 attributes.
int outputs_number(const corpus::Outputs& o) {
  return o.count + 2 * o.index + 4 * o.depth + 8 * o.barycentrics + 16 * o.attributes;
}

std::string models_json(const File& file) {
  std::set<Model> used;
  for (const Test& test : file.tests) used.insert(test.models.begin(), test.models.end());
  return joined(used, ",\n  ", [](Model model) {
    if (model == Model::exact) return std::string("\"exact\": {\"sections\": \"1 to 9 of docs/semantics.md\"}");
    const int bits = kModelBits[static_cast<std::size_t>(model)];
    return fmt::format(
        "\"{}\": {{\"sections\": \"11 of docs/semantics.md\", \"bits\": {}, \"rounding\": \"nearest_even\", "
        "\"slivers\": \"open\", \"within\": [3, {}], "
        "\"roundings\": [{}, 16777216]}}",
        kModelNames[static_cast<std::size_t>(model)], bits, 2 << bits, kGrantedRoundings);
  });
}

// What few targets have: origin, own places of the samples, layers.
std::string further_json(const corpus::Scene& scene) {
  std::string text;
  if (scene.origin != Origin{}) text += fmt::format(", \"origin\": [{}, {}]", scene.origin.x, scene.origin.y);
  if (!scene.sample_locations.empty()) {
    text += ", \"sample_locations\": [" +
            joined(scene.sample_locations, ", ",
                   [](const SampleLocation& at) { return fmt::format("[{}, {}]", at.x, at.y); }) +
            "]";
  }
  if (scene.layers > 1) text += fmt::format(", \"layers\": {}", scene.layers);
  return text;
}

}  // namespace

std::string json_of(const Test& test) {
  const corpus::Scene& scene = test.frames.front().scene;
  std::string text = fmt::format("  {{\"id\": {}, \"comment\": {},\n", test.id, quoted(test.comment));
  text += "   \"flags\": " + list(test.flags) + ",\n   \"kills\": " + list(test.kills) +
          ",\n   \"rules\": " + list(test.rules);
  text += ", \"models\": [" +
          joined(test.models, ", ", [](Model m) { return quoted(kModelNames[static_cast<std::size_t>(m)]); }) + "],\n";
  text += fmt::format(
      "   \"target\": {{\"width\": {}, \"height\": {}, \"samples\": {}, \"depth_test\": \"{}\", "
      "\"attribute_location\": \"{}\"{}}},\n",
      scene.width, scene.height, scene.samples,
      underlined(corpus::kDepthTestNames[static_cast<std::size_t>(scene.depth_test)].second),
      corpus::kAttributeLocationNames[static_cast<std::size_t>(scene.attribute_location)].second, further_json(scene));
  if (test.window)
    text += fmt::format("   \"window\": [{}, {}, {}, {}],\n", (*test.window)[0], (*test.window)[1], (*test.window)[2],
                        (*test.window)[3]);
  text += "   \"frames\": [\n     " +
          joined(test.frames, ",\n     ", [&](const VectorFrame& frame) { return frame_json(test, frame); });
  return text + "]}";
}

std::string json_of(const File& file, const Faults& effects) {
  std::set<std::string> faults;
  for (const Test& test : file.tests) faults.insert(test.kills.begin(), test.kills.end());
  std::string text = fmt::format(
      "{{\"format\": \"surefill-vectors\", \"version\": 1, \"subject\": {}, \"title\": {},\n \"schema\": "
      "\"schemas/{}.json\",\n",
      quoted(file.subject.name), quoted(file.subject.title), file.subject.name);
  text += " \"models\": {\n  " + models_json(file) + "},\n \"notes\": {";
  bool first = true;
  for (const zoo::Specimen& specimen : zoo::specimens()) {
    if (!faults.contains(specimen.name)) continue;
    const auto effect = effects.find(specimen.name);
    text += fmt::format("{}\n  {}: {{\"bug\": {}, \"effect\": {}, \"origin\": {}, \"specimen\": {}}}", first ? "" : ",",
                        quoted(specimen.name), quoted(specimen.fault),
                        quoted(effect == effects.end() ? "" : effect->second.text()),
                        quoted(*specimen.seen_in == '\0' ? "thought of" : specimen.seen_in), quoted(specimen.name));
    first = false;
  }
  text += fmt::format("}},\n \"number_of_tests\": {},\n \"tests\": [\n", file.tests.size());
  text += joined(file.tests, ",\n", [](const Test& test) { return json_of(test); });
  return text + "]}\n";
}

std::string schema_of(const File& file) {
  const corpus::Outputs& o = file.subject.outputs;
  const bool smoke = file.subject.name == "smoke";
  const auto words = [](const auto& names) {
    return joined(names, ", ", [](const auto& name) { return quoted(underlined(name.second)); });
  };
  // Conservative frames have counts alone, and a file's test may ask for less.
  const std::string required = !smoke && outputs_number(o) == 1 ? "\"count\"" : "";
  const std::string models = smoke ? joined(kModelNames, ", ", quoted)
                             : file.subject.model == Model::exact
                                 ? joined(kModelNames, ", ", quoted)
                                 : quoted(kModelNames[static_cast<std::size_t>(file.subject.model)]);
  std::string members = "\"count\": {\"$ref\": \"#/$defs/wholes\"}, \"open\": {\"$ref\": \"#/$defs/wholes\"}";
  if (smoke || o.index) members += ",\n      \"index\": {\"$ref\": \"#/$defs/wholes\"}";
  if (smoke || o.depth) members += ",\n      \"depth\": {\"$ref\": \"#/$defs/reals\"}";
  if (smoke || o.barycentrics)
    members +=
        ",\n      \"barycentrics\": {\"type\": \"array\", \"minItems\": 3, \"maxItems\": 3, \"items\": {\"$ref\": "
        "\"#/$defs/reals\"}}";
  if (smoke || o.attributes)
    members +=
        ",\n      \"attributes\": {\"type\": \"array\", \"items\": {\"type\": \"array\", \"minItems\": 1, "
        "\"maxItems\": 4, \"items\": {\"$ref\": \"#/$defs/reals\"}}}";
  if (smoke || file.subject.name == "modes")
    members += ",\n      \"winding\": {\"type\": \"array\", \"items\": {\"type\": \"integer\"}}";
  std::string text =
      R"({"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "Surefill test vectors: @subject", "type": "object",
 "required": ["format", "version", "subject", "title", "schema", "models", "notes", "number_of_tests", "tests"], "additionalProperties": false,
 "properties": {
  "format": {"const": "surefill-vectors"}, "version": {"const": 1}, "subject": {"const": "@subject"},
  "title": {"type": "string"}, "schema": {"const": "schemas/@subject.json"}, "number_of_tests": {"type": "integer", "minimum": 1},
  "models": {"type": "object", "propertyNames": {"enum": ["exact", "grid4", "grid8"]}, "additionalProperties": {"$ref": "#/$defs/model"}},
  "notes": {"type": "object", "additionalProperties": {"type": "object", "required": ["bug", "effect", "origin", "specimen"],
   "additionalProperties": {"type": "string"}}},
  "tests": {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/test"}}},
 "$defs": {
  "words": {"type": "array", "items": {"type": "string"}},
  "bits": {"type": "string", "pattern": "^[0-9a-f]{8}$"},
  "wholes": {"description": "alternately the length of a run and its value", "type": "array", "items": {"type": "integer", "minimum": 0, "maximum": 4294967295}},
  "reals": {"description": "alternately the length of a run and its value: the bits of a float32, or those of the two ends of an interval", "type": "array",
   "items": {"anyOf": [{"type": "integer", "minimum": 1}, {"type": "string", "pattern": "^[0-9a-f]{8}(:[0-9a-f]{8})?$"}]}},
  "rectangle": {"description": "x0, y0, x1, y1, half-open", "type": "array", "minItems": 4, "maxItems": 4, "items": {"type": "integer"}},
  "model": {"type": "object", "required": ["sections"], "additionalProperties": false, "properties": {"sections": {"type": "string"},
   "bits": {"type": "integer"}, "rounding": {"const": "nearest_even"}, "slivers": {"const": "open"},
   "within": {"type": "array", "items": {"type": "integer"}}, "roundings": {"type": "array", "items": {"type": "integer"}}}},
  "state": {"type": "object", "required": ["fill_rule", "front_face", "cull", "depth_mode", "depth_write", "conservative"], "additionalProperties": false,
   "properties": {"fill_rule": {"enum": [@fill_rules]}, "front_face": {"enum": [@front_faces]}, "cull": {"enum": [@culls]},
    "depth_mode": {"enum": [@depth_modes]}, "depth_write": {"type": "boolean"}, "conservative": {"enum": [@conservatives]},
    "scissor": {"$ref": "#/$defs/rectangle"},
    "grid": {"description": "bits, offset of x and of y in 2^-(bits + 4) pixels, rounding", "type": "array", "minItems": 4, "maxItems": 4,
     "items": {"anyOf": [{"type": "integer", "minimum": 0, "maximum": 15}, {"enum": [@roundings]}]}},
    "culling_box": {"type": "array", "minItems": 32, "maxItems": 32, "items": {"$ref": "#/$defs/bits"}},
    "depth_bias": {"description": "constant, slope", "type": "array", "minItems": 2, "maxItems": 2, "items": {"$ref": "#/$defs/bits"}}}},
  "draw": {"type": "object", "required": ["state", "vertices", "triangles"], "additionalProperties": false, "properties": {
   "state": {"$ref": "#/$defs/state"},
   "vertices": {"type": "object", "required": ["bits", "decimal"], "additionalProperties": false, "properties": {
    "bits": {"type": "array", "items": {"type": "array", "minItems": 4, "maxItems": 4, "items": {"$ref": "#/$defs/bits"}}},
    "decimal": {"type": "array", "items": {"type": "array", "minItems": 4, "maxItems": 4, "items": {"anyOf": [{"type": "number"}, {"enum": ["nan", "inf", "-inf"]}]}}}}},
   "triangles": {"type": "array", "items": {"type": "array", "minItems": 3, "maxItems": 3, "items": {"type": "integer", "minimum": 0}}},
   "identifiers": {"description": "one for each triangle", "type": "array", "items": {"type": "integer", "minimum": 0, "maximum": 4294967294}}, "first_index": {"type": "integer", "minimum": 0},
   "attributes": {"type": "array", "items": {"type": "object", "required": ["interpolation", "bits"], "additionalProperties": false, "properties": {
    "interpolation": {"enum": ["perspective", "noperspective", "flat"]},
    "bits": {"type": "array", "items": {"type": "array", "minItems": 1, "maxItems": 4, "items": {"$ref": "#/$defs/bits"}}}}}}}},
  "frame": {"type": "object", "required": ["draws", "expected"], "additionalProperties": false, "properties": {
   "initial_depth": {"anyOf": [{"const": "previous"}, {"$ref": "#/$defs/reals"}]},
   "draws": {"type": "array", "items": {"$ref": "#/$defs/draw"}},
   "expected": {"type": "object", "minProperties": 1, "required": [@required], "additionalProperties": false, "properties": {
      @members}}}},
  "test": {"type": "object", "required": ["id", "comment", "flags", "kills", "rules", "models", "target", "frames"], "additionalProperties": false, "properties": {
   "id": {"type": "integer", "minimum": 1}, "comment": {"type": "string"}, "flags": {"$ref": "#/$defs/words"},
   "kills": {"$ref": "#/$defs/words"}, "rules": {"$ref": "#/$defs/words"},
   "models": {"type": "array", "minItems": 1, "items": {"enum": [@models]}},
   "target": {"type": "object", "required": ["width", "height", "samples", "depth_test", "attribute_location"], "additionalProperties": false, "properties": {
    "width": {"type": "integer", "minimum": 1, "maximum": 16384}, "height": {"type": "integer", "minimum": 1, "maximum": 16384},
    "samples": {"enum": [1, 2, 4, 8, 16]}, "depth_test": {"enum": [@depth_tests]}, "attribute_location": {"enum": ["centre", "centroid"]},
    "origin": {"type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "integer"}},
    "sample_locations": {"type": "array", "items": {"type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "integer", "minimum": 0, "maximum": 15}}},
    "layers": {"type": "integer", "minimum": 2, "maximum": 16}}},
   "window": {"$ref": "#/$defs/rectangle"},
   "frames": {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/frame"}}}}}}
)";
  const auto put = [&text](const std::string& mark, const std::string& value) {
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + value.size()))
      text.replace(at, mark.size(), value);
  };
  put("@subject", file.subject.name), put("@required", required), put("@models", models), put("@members", members);
  put("@depth_tests", words(corpus::kDepthTestNames));
  put("@fill_rules", words(corpus::kFillRuleNames)), put("@front_faces", words(corpus::kFrontFaceNames)),
      put("@culls", words(corpus::kCullNames));
  put("@depth_modes", words(corpus::kDepthModeNames)), put("@conservatives", words(corpus::kConservativeNames));
  put("@roundings", words(corpus::kGridRoundingNames));
  return text;
}

std::string text_of(const Test& test, bool with_expectations) {
  const corpus::Scene& scene = test.frames.front().scene;
  int models = 0;
  for (const Model model : test.models) models |= 1 << static_cast<int>(model);
  const auto [x0, y0, x1, y1] = test.window.value_or(std::array<int, 4>{0, 0, scene.width, scene.height});
  std::string further = fmt::format("{} {} {}", scene.origin.x, scene.origin.y, scene.sample_locations.size());
  for (const SampleLocation& at : scene.sample_locations) further += fmt::format(" {} {}", at.x, at.y);
  const int outputs = outputs_number(test.outputs) + (test.frames.front().expected.winding.empty() ? 0 : 32);
  std::string text =
      fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {}", models, scene.width, scene.height, scene.samples,
                  static_cast<int>(scene.depth_test), static_cast<int>(scene.attribute_location), further, scene.layers,
                  x0, y0, x1, y1, outputs, test.frames.size());
  for (const VectorFrame& frame : test.frames) {
    if (frame.previous) {
      text += " 2";
    } else if (frame.scene.initial_depth.empty()) {
      text += " 0";
    } else {
      std::vector<std::string> values;
      const std::size_t total = static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height) *
                                static_cast<std::size_t>(scene.samples);
      for (std::size_t s = 0; s < total; ++s)
        values.push_back(hex(frame.scene.initial_depth[frame.scene.initial_depth.size() == 1 ? 0 : s]));
      text += " 1 " + runs(values, " ", true);
    }
    text += fmt::format(" {}", frame.scene.draws.size());
    for (const corpus::SceneDraw& draw : frame.scene.draws) {
      const std::uint32_t first = has_identifiers(draw) ? 0 : draw.first_index.value_or(0);
      text += " " + state_text(draw) + fmt::format(" {} {}", first, draw.vertices.size());
      for (const corpus::SceneVertex& v : draw.vertices)
        text += " " + hex(v.x) + " " + hex(v.y) + " " + hex(v.z) + " " + hex(v.w);
      text += fmt::format(" {}", draw.triangles.size());
      for (const corpus::SceneTriangle& t : draw.triangles)
        text += fmt::format(" {} {} {}", t.vertices[0], t.vertices[1], t.vertices[2]);
      text += has_identifiers(draw) ? " 1" : " 0";
      if (has_identifiers(draw))
        for (const corpus::SceneTriangle& t : draw.triangles) text += fmt::format(" {}", *t.identifier);
      text += fmt::format(" {}", frame.scene.attributes.size());
      std::size_t offset = 0;
      for (const corpus::SceneAttribute& attribute : frame.scene.attributes) {
        text += fmt::format(" {} {}", attribute.components, static_cast<int>(attribute.interpolation));
        for (const corpus::SceneVertex& v : draw.vertices)
          for (std::size_t c = 0; c < attribute.components; ++c) text += " " + hex(v.attributes[offset + c]);
        offset += attribute.components;
      }
    }
  }
  const auto words = 2 + std::count(text.begin(), text.end(), ' ') + 1;
  text = fmt::format("{} {} ", test.id, words) + text;
  if (!with_expectations) return text;
  for (const VectorFrame& frame : test.frames) {
    for (const bool high : {false, true})
      for (const Plane& plane : planes_of(test, frame, false, high)) text += " " + runs(plane.values, " ", true);
  }
  return text;
}

std::string faults_of(const File& file) {
  std::string text;
  for (const zoo::Specimen& specimen : zoo::specimens()) {
    std::string ids;
    for (const Test& test : file.tests)
      if (test.kills.contains(specimen.name)) ids += " " + std::to_string(test.id);
    if (!ids.empty()) text += specimen.name + ids + "\n";
  }
  return text;
}

}  // namespace surefill::vectors
