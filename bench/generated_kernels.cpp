// Kernels that coapt.energy wrote (cord.hpp, rubber.hpp, the folder of which is an include path) beside those
// of the library, the cord of Burlina and the neo-Hookean triangle.
//   values < states   of each line of coordinates ("cord" and 6 of x; "rubber", 9 of X and 9 of x): energy,
//                     gradient and Hessian of ours and of the generated kernel, a line each
//   projected < states  of each line the projected Hessian of the generated kernel, and in the next line what
//                     an eigenvalue decomposition makes of its exact one
//   time              nanoseconds of an evaluation of each: value, with gradient, with Hessian, with
//   projected
//                     Hessian; best of several
// bench/kernels.py measures with it, tests/python/kernel_test.py compares.
#include "cord.hpp"
#include "energy/kernels/cst_isotropic.hpp"
#include "energy/kernels/tether_cubic.hpp"
#include "energy/project_psd.hpp"
#include "rubber.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace coapt;

constexpr double kStrength = 0.3, kLength = 1.2, kScale = 0.7;  // of the cord [mJ, mm, mm]
constexpr double kShear = 0.33, kThickness = 0.8;               // of the triangle [MPa, mm]

TetherCubic::Rest cord() { return {kStrength, kLength, kScale}; }
CstNeoHookean::Rest triangle(const CstVector& X) {
  return CstNeoHookean::rest(X.head<3>(), X.segment<3>(3), X.tail<3>(), NeoHookeanLaw{{kShear}, 0},
                             kThickness, false);
}
Rubber::Rest rubber(const CstVector& X) {
  return Rubber::rest(X.head<3>(), X.segment<3>(3), X.tail<3>(), kShear, kThickness);
}

template <typename Kernel, typename Vector>
void print(const typename Kernel::Rest& rest, const Vector& x) {
  Vector g;
  Eigen::Matrix<double, Vector::RowsAtCompileTime, Vector::RowsAtCompileTime> H;
  std::printf("%.17g", Kernel::evaluate(rest, x, &g, &H));
  for (const double value : g) std::printf(" %.17g", value);
  for (const double value : H.reshaped()) std::printf(" %.17g", value);
  Vector alone;
  std::printf(" %.17g", Kernel::evaluate(rest, x, nullptr, nullptr));
  std::printf(" %.17g\n", Kernel::evaluate(rest, x, &alone, nullptr) + (alone - g).norm());
}

template <typename Kernel, typename Vector>
void print_projected(const typename Kernel::Rest& rest, const Vector& x) {
  Vector g;
  Eigen::Matrix<double, Vector::RowsAtCompileTime, Vector::RowsAtCompileTime> H, decomposed;
  Kernel::evaluate_projected(rest, x, &g, &H);
  Kernel::evaluate(rest, x, &g, &decomposed);
  project_psd(decomposed);
  for (const auto& matrix : {H, decomposed}) {
    for (const double value : matrix.reshaped()) std::printf(" %.17g", value);
    std::printf("\n");
  }
}

template <typename Vector>
Vector read() {
  Vector x;
  for (double& value : x) std::cin >> value;
  return x;
}

void values(bool projects) {
  for (std::string kind; std::cin >> kind;) {
    if (kind == "cord") {
      const auto x = read<Eigen::Vector<double, 6>>();
      if (projects) {
        print_projected<Cord>(Cord::rest(kStrength, kLength, kScale), x);
        continue;
      }
      print<TetherCubic>(cord(), x);
      print<Cord>(Cord::rest(kStrength, kLength, kScale), x);
    } else {
      const auto X = read<CstVector>(), x = read<CstVector>();
      if (projects) {
        print_projected<Rubber>(rubber(X), x);
        continue;
      }
      print<CstNeoHookean>(triangle(X), x);
      print<Rubber>(rubber(X), x);
    }
  }
}

// Best of several passes over all elements [ns for each].
template <typename Kernel, typename Vector>
double nanoseconds(const std::vector<typename Kernel::Rest>& rest, const std::vector<Vector>& x, int what) {
  using Clock = std::chrono::steady_clock;
  Vector g = Vector::Zero();
  Eigen::Matrix<double, Vector::RowsAtCompileTime, Vector::RowsAtCompileTime> H;
  H.setZero();
  double best = 1e300, sum = 0;
  constexpr int kPasses = 300;
  for (int pass = 0; pass < kPasses; ++pass) {
    const auto start = Clock::now();
    for (size_t e = 0; e < x.size(); ++e) {
      sum += what == 3 ? Kernel::evaluate_projected(rest[e], x[e], &g, &H)
                       : Kernel::evaluate(rest[e], x[e], what > 0 ? &g : nullptr, what > 1 ? &H : nullptr);
      sum += g[0] + H(0, 0);
    }
    best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - start).count());
  }
  if (sum == 0) std::puts("nothing was computed");  // so that the compiler leaves nothing out
  return best / static_cast<double>(x.size());
}

template <typename Kernel, typename Vector>
void report(const char* name, const std::vector<typename Kernel::Rest>& rest, const std::vector<Vector>& x) {
  std::printf("%s:", name);
  for (int what = 0; what < 4; ++what) std::printf(" %.2f", nanoseconds<Kernel>(rest, x, what));
  std::printf("\n");
}

// Cords, half of them taut, and triangles: stretched both ways, and a third each of those, of such as are
// stretched along and narrowed more than the stretch does it, and of such as are compressed both ways.
void times() {
  constexpr int kElements = 2000;
  std::srand(1);
  std::vector<Eigen::Vector<double, 6>> ends;
  std::vector<CstVector> corners, mixed;
  std::vector<CstNeoHookean::Rest> ours;
  std::vector<Rubber::Rest> generated;
  for (int e = 0; e < kElements; ++e) {
    Eigen::Vector<double, 6> cord_ends = Eigen::Vector<double, 6>::Zero();
    cord_ends.tail<3>() = kLength * (e % 2 == 0 ? 1.3 : 0.8) * Vec3::Random().normalized();
    ends.push_back(cord_ends);
    CstVector X;
    X << 0, 0, 0, 1, 0, 0, 0, 1, 0;
    const CstVector noise = 0.05 * CstVector::Random();
    corners.push_back(1.2 * X + noise);
    CstVector x = X;
    x[3] *= e % 3 == 2 ? 0.85 : 1.2;
    x[7] *= std::vector<double>{1.2, 0.7, 0.9}[e % 3];
    mixed.push_back(x + noise);
    ours.push_back(triangle(X));
    generated.push_back(rubber(X));
  }
  report<TetherCubic>("TetherCubic", std::vector<TetherCubic::Rest>(kElements, cord()), ends);
  report<Cord>("Cord", std::vector<Cord::Rest>(kElements, Cord::rest(kStrength, kLength, kScale)), ends);
  report<CstNeoHookean>("CstNeoHookean", ours, corners);
  report<Rubber>("Rubber", generated, corners);
  report<CstNeoHookean>("CstNeoHookean mixed", ours, mixed);
  report<Rubber>("Rubber mixed", generated, mixed);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "time")
    times();
  else
    values(argc > 1 && std::string(argv[1]) == "projected");
}
