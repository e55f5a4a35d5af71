// The methods that a comparison or a benchmark may name, and what each of them solves. Private to this room.
#pragma once

#include "core/error.hpp"
#include "study/comparison.hpp"

#include <string>
#include <vector>

namespace coapt {

// Goes on from a shape to its equilibrium.
inline constexpr const char* kRefiningSolver = "newton";

// What the user chose, as ComparisonOptions has it.
struct MethodChoice {
  std::vector<std::string> methods;
  std::string reference;
  std::filesystem::path closed;
};

// Adds what is wrong with the choice: methods that are not known or named twice, a reference that is not
// among them, a closed surface that is not there or that nothing could be compared with.
void check_methods(const Scene& scene, const SolverTable& solvers, const MethodChoice& choice,
                   std::vector<std::string>& defects);

// The methods in the order in which they are solved. reference: one of them; empty: "newton" where it is
// among them, else the first.
std::vector<std::string> reference_first(std::vector<std::string> methods, const std::string& reference);

MethodModel model_of(const std::string& method, const Scene& scene);

// The scene that the method solves. Throws InputError where springs cannot take the place of its membranes.
Scene scene_of(const std::string& method, const Scene& scene);

// What a method that has run, or failed, has in common with newton, as "energy + contact + factorisation":
// the energy that it minimises (else the loads, or "nothing"), the contact terms, and steps by factorised
// Hessians.
std::string shared_with_newton(const ComparedMethod& method, const Scene& scene);

// The scene with another closed surface to be compared with, in the unit of its mesh; empty: its own.
Scene with_closed_surface(Scene scene, const std::filesystem::path& closed);

// All defects, with semicolons between them.
std::string in_one_line(const InputError& error);

}  // namespace coapt
