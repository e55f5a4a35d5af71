// The solvers that move masses by forces alone: what they find, and what they refuse.
#include "core/error.hpp"
#include "energy/load_dead.hpp"
#include "optim/dynamic/dynamic.hpp"
#include "support/equilibrium.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

// A chain of ten links that hangs between two points.
struct Hung {
  Points X = Points::Zero(3, 11), weights = Points::Zero(3, 11);
  Segments links{2, 10};
  Vector masses = Vector::Constant(11, 0.1);
  Hung() {
    for (int k = 0; k <= 10; ++k) X(0, k) = 0.1 * k;
    for (int k = 0; k < 10; ++k) links.col(k) << k, k + 1;
    weights.row(2).setConstant(-0.981);
  }
  Objective objective() const {
    return Objective(X, fixed_nodes(11, {0, 10}),
                     terms_of(cable_term(links, 100, Vector::Constant(10, 0.12)),
                              std::make_unique<LoadDead>("weight", "load_field", weights, X)));
  }
};

// No matrix is factorised, and no damped path leads them: their own motion does.
TEST(Dynamic, ExplicitOnesComeToRestByForcesAlone) {
  const Hung hung;
  Objective objective = hung.objective();
  const Result newton =
      solve(*built_in_solvers().at("newton")({}), {objective, objective.unknowns(hung.X)}, {1e-11});
  for (const char* name : {"dynamic", "dynamic-explicit", "mass-spring"}) {
    SolverOptions options;
    options.dynamic = {.time_step = 1e-2, .relaxation_time = 0.2};
    options.masses = [&hung] { return hung.masses; };
    Objective hanging = hung.objective();
    Problem problem{hanging, hanging.unknowns(hung.X)};
    problem.continuation.damped_steps = 3;
    const Result result = solve(*built_in_solvers().at(name)(options), problem, {1e-9, 200000});
    ASSERT_EQ(result.status, Status::Converged) << name << ": " << result.message;
    EXPECT_LT((result.q - newton.q).cwiseAbs().maxCoeff(), 1e-7) << name;
    const bool is_implicit = std::string(name) == "dynamic";
    EXPECT_EQ(result.factorised_steps > 0, is_implicit) << name;
    EXPECT_EQ(result.damped_steps > 0, is_implicit) << name;
    EXPECT_TRUE(is_dynamic(name));
  }
  EXPECT_FALSE(is_dynamic("newton"));
}

TEST(Dynamic, MassSpringRefusesMembranesAndSaysWhatToTake) {
  SolverOptions options;
  options.masses = [] { return Vector(Vector::Ones(3)); };
  options.membranes = [] { return std::vector<std::string>(); };
  EXPECT_NO_THROW(make_mass_spring(options));
  options.membranes = [] { return std::vector<std::string>{"\"a\" (cst_stvk)", "\"b\" (cst_stvk)"}; };
  EXPECT_NO_THROW(make_dynamic_explicit(options));
  try {
    make_mass_spring(options);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    ASSERT_EQ(error.defects().size(), 2U);
    for (const char* word : {"\"b\" (cst_stvk)", "\"spring\"", "compare", "dynamic-explicit"})
      EXPECT_NE(error.defects()[1].find(word), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace coapt
