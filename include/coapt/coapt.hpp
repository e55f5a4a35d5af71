// What a program needs of Coapt at first: meshes, energies, solvers and derivatives (link coapt::core), and,
// where the library has them, scene files, valves and their solution (link coapt::scene). Other headers are
// included by their room, as in "energy/kernels/spring.hpp". Lengths are mm, forces N, stresses MPa, energies
// mJ.
#pragma once

#include "coapt/version.hpp"

#if __cplusplus < 202002L && (!defined(_MSVC_LANG) || _MSVC_LANG < 202002L)
#error \
    "Coapt needs C++20: compile with -std=c++20 (MSVC: /std:c++20 /Zc:__cplusplus), or link coapt::core in CMake, which sets it"
#else

#include "core/alignment.hpp"
#include "core/components.hpp"
#include "core/error.hpp"
#include "core/types.hpp"
#include "energy/contact_barrier.hpp"
#include "energy/derivative_check.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/bending.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/cst_fibrous.hpp"
#include "energy/kernels/cst_isotropic.hpp"
#include "energy/kernels/cst_stvk.hpp"
#include "energy/kernels/cst_tension_field.hpp"
#include "energy/load_dead.hpp"
#include "energy/load_pressure.hpp"
#include "energy/objective.hpp"
#include "mesh/mesh_check.hpp"
#include "mesh/mesh_topology.hpp"
#include "mesh/shapes.hpp"
#include "mesh/triangle_mesh.hpp"
#include "optim/solver.hpp"
#include "sensitivity/tracked_equilibrium.hpp"

// A library with Eigen alone is installed without these.
#if __has_include("run/solve_scene_file.hpp")
#include "exchange/import.hpp"
#include "results/results.hpp"
#include "run/run.hpp"
#include "run/solve_scene_file.hpp"
#include "scene/file/scene.hpp"
#include "solve/solve_scene.hpp"
#endif

#endif
