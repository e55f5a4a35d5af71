#include "stress/scenes/bad_scenes.hpp"

namespace coapt {

const char* const kSoundScene = R"({
  "mesh": { "file": "mesh.obj" },
  "boundary": [{ "nodes": "boundary", "fix": true }],
  "terms": [
    { "type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm" },
    { "type": "load_pressure", "value": "0.1 kPa" }
  ],
  "solver": { "type": "newton", "tolerance": 1e-6 }
})";
const char* const kSoundMesh =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0\n"
    "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

namespace {

// The sound scene with one piece of text in the place of another, which it must have.
std::string with(const std::string& piece, const std::string& other) {
  std::string text = kSoundScene;
  return text.replace(text.find(piece), piece.size(), other);
}

std::string with_term(const std::string& term) {
  return with(R"("value": "0.1 kPa" })", R"("value": "0.1 kPa" }, )" + term);
}

std::string repeated(const std::string& piece, int count) {
  std::string text;
  for (int k = 0; k < count; ++k) text += piece;
  return text;
}

std::vector<BadScene> bad_keys() {
  const std::string young = R"("1 MPa")", pressure = R"("0.1 kPa")";
  return {{"an unknown key", with("\"mesh\"", "\"meshh\""), {"meshh", "mesh"}},
          {"an unknown key of a term", with("young", "yuong"), {"terms[0].yuong", "young"}},
          {"an unknown key of the solver", with("tolerance", "tolerence"), {"solver.tolerence", "tolerance"}},
          {"an unknown term", with("cst_stvk", "cst_stkv"), {"terms[0].type", "cst_stkv", "cst_stvk"}},
          {"an unknown solver", with("newton", "newtn"), {"solver.type", "newtn", "newton"}},
          {"a key twice", with("\"poisson\"", "\"poisson\": 0.2, \"poisson\""), {"poisson", "twice"}},
          {"a term without its thickness", with(R"(, "thickness": "0.1 mm")", ""), {"terms[0]", "thickness"}},
          {"a list for an object", with(R"({ "nodes": "boundary", "fix": true })", "[]"), {"boundary[0]"}},
          {"a number for a quantity", with(young, "1"), {"terms[0].young", "unit"}},
          {"a text for a number", with("0.3", "\"a third\""), {"terms[0].poisson"}},
          {"null", with(young, "null"), {"terms[0].young", "null"}},
          {"no unit", with(young, "\"1\""), {"terms[0].young", "unit", "pressure"}},
          {"an unknown unit", with("1 MPa", "1 parsnip"), {"terms[0].young", "parsnip"}},
          {"a unit of something else", with("1 MPa", "1 kg"), {"terms[0].young", "mass"}},
          {"a negative stiffness", with("1 MPa", "-1 MPa"), {"terms[0].young", "-1 MPa"}},
          {"a negative thickness", with("0.1 mm", "-0.1 mm"), {"terms[0].thickness", "-0.1 mm"}},
          {"a thickness of zero", with("\"0.1 mm\"", "0"), {"terms[0].thickness"}},
          {"Poisson's ratio -1", with("0.3", "-1"), {"terms[0].poisson", "-1"}},
          {"Poisson's ratio 1.2", with("0.3", "1.2"), {"terms[0].poisson", "1.2"}},
          {"a pressure NaN", with(pressure, "NaN"), {"JSON"}},
          {"a pressure of text NaN", with("0.1 kPa", "nan kPa"), {"terms[1].value", "finite"}},
          {"a quantity beyond range", with("1 MPa", "1e400 MPa"), {"terms[0].young", "range"}},
          {"a tolerance of zero", with("1e-6", "0"), {"solver.tolerance"}},
          {"a term of another kind",
           with_term(R"({ "type": "contact_facet", "exponent": 1 })"),
           {"terms[2].exponent"}}};
}

std::vector<BadScene> bad_references() {
  return {
      {"a mesh that is not there", with("mesh.obj", "nothere.obj"), {"mesh.file", "nothere.obj"}},
      {"a set that is not there", with("\"boundary\", ", "\"annulus\", "), {"boundary[0].nodes", "annulus"}},
      {"a node that is not there", with("\"boundary\", ", "[0, 9999], "), {"boundary[0].nodes", "9999"}},
      {"a region that is not there",
       with("\"young\"", "\"region\": \"foo\", \"young\""),
       {"terms[0].region", "foo"}},
      {"a network that is not there",
       with_term(R"({ "type": "cable", "young": "1 MPa", "network": "nothere.json" })"),
       {"terms[2].network", "nothere.json"}},
      {"a chord to a vertex that is not there",
       with_term(R"({ "type": "cable", "young": "1 MPa", "network": "far.json" })"),
       {"far.json", "chords[0].to.leaflet", "9999"}},
      {"a pressure with a potential on a free rim",
       with(R"("0.1 kPa" })", R"("0.1 kPa", "model": "volume" })")
           .replace(std::string(kSoundScene).find("\"boundary\", "), 12, "[0, 1, 2], "),
       {"terms[1].model", "volume"}}};
}

std::vector<BadScene> bad_texts() {
  constexpr int kDeep = 1000000, kLong = 100000000;
  const std::string sound = kSoundScene;
  return {{"an empty file", "", {"1:1", "JSON"}},
          {"an empty scene", "{}", {"terms", "missing"}},
          {"a scene that is cut off", sound.substr(0, 80), {"JSON"}},
          {"text after the end", sound + " x", {"JSON"}},
          {"bytes that are no text", std::string("\xff\xfe{\x00}", 5), {"1:1"}},
          {"a million lists in each other", repeated("[", kDeep), {"nested"}},
          {"a million objects in each other",
           repeated("{\"a\":", kDeep) + "1" + repeated("}", kDeep),
           {"nested"}},
          {"a line of 100 MB", "{\"name\": \"" + std::string(kLong, 'x') + "\"}", {"MB"}}};
}

}  // namespace

std::vector<BadScene> bad_scenes() {
  std::vector<BadScene> all = bad_keys();
  for (const auto& more : {bad_references(), bad_texts()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace coapt
