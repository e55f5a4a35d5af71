// Held nodes and pressures of an Abaqus input file at the end of its last step.
#pragma once

#include "formats/abaqus/abaqus_assembly.hpp"
#include "formats/fe_model.hpp"

#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace coapt::formats {

struct AbaqusPressure {
  std::string target;      // a surface, or for *Dload elements
  bool is_surface = true;  // else on elements, positive along their normal
  double value = 0;
  int line = 0;
};

class AbaqusHistory {
 public:
  AbaqusHistory(const AbaqusAssembly& assembly, Defects& defects) : assembly_(assembly), defects_(defects) {}

  // True where the keyword is one of amplitudes, steps, supports and pressures, and was taken.
  bool take(const AbaqusCard& card);

  const std::map<std::tuple<int, long long>, FeHold>& holds() const { return holds_; }  // by scope and label
  const std::vector<AbaqusPressure>& pressures() const { return pressures_; }
  const std::map<std::string, int>& left_out() const { return left_out_; }  // what, and the first line
  bool is_in_step() const { return in_step_; }

 private:
  struct Amplitude {
    std::vector<std::pair<double, double>> points;
    bool is_smooth = false, is_total_time = false;
  };

  void read_amplitude(const AbaqusCard& card);
  void begin_step(const AbaqusCard& card);
  void read_period(const AbaqusCard& card);
  double final_factor(const AbaqusCard& card);
  void read_boundary(const AbaqusCard& card);
  void hold(const AbaqusLine& line, const AbaqusCard& card, double factor);
  void read_pressure(const AbaqusCard& card, bool is_surface);
  bool renews(const AbaqusCard& card, std::set<std::string>& renewed);

  const AbaqusAssembly& assembly_;
  Defects& defects_;
  std::map<std::string, Amplitude> amplitudes_;
  std::map<std::tuple<int, long long>, FeHold> holds_;
  std::vector<AbaqusPressure> pressures_;
  std::map<std::string, int> left_out_;
  std::set<std::string> renewed_;  // keywords that began anew in this step
  double period_ = 1, total_time_ = 0;
  bool in_step_ = false;
};

}  // namespace coapt::formats
