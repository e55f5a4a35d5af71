// The numbers of XpbdPaper by the names that scene files and messages have for them.
#pragma once

#include "xpbd/options.hpp"

#include <array>

namespace coapt {

struct PaperNumber {
  const char* name;
  double XpbdPaper::*value;
  bool is_share;  // from 0 to 1; else any number from 0 on
  const char* doc;
};

inline constexpr std::array kPaperNumbers{
    PaperNumber{"stretch", &XpbdPaper::stretch, true,
                "Share of a correction of edges that is applied in one sweep (k0)."},
    PaperNumber{"bending", &XpbdPaper::bending, true,
                "Share of a correction of hinges that is applied in one sweep (k1)."},
    PaperNumber{"area", &XpbdPaper::area, true,
                "Share of a correction of areas that is applied in one sweep (k2)."},
    PaperNumber{"tether", &XpbdPaper::tether, true,
                "Share of a correction of chords and clips that is applied in one sweep (eq. 15)."},
    PaperNumber{"contact", &XpbdPaper::contact, true,
                "Share of a correction of contact that is applied in one sweep (k3)."},
    PaperNumber{"compliance", &XpbdPaper::compliance, false,
                "Compliance alpha of edges, hinges and areas, in mm, s and masses of 1; 0: plain "
                "position-based dynamics."},
    PaperNumber{"tether_compliance", &XpbdPaper::tether_compliance, false,
                "Compliance of chords and clips (eq. 15, section 3.8)."},
    PaperNumber{"contact_compliance", &XpbdPaper::contact_compliance, false,
                "Compliance of contact (alpha3)."},
    PaperNumber{"flow", &XpbdPaper::flow, false,
                "Weight w of the flow field, a force on the mass 1 in mm and s."},
    PaperNumber{"pressure", &XpbdPaper::pressure, false,
                "Weight p of the pressure, a force on the mass 1 in mm and s."},
    PaperNumber{"radial", &XpbdPaper::radial, false,
                "Weight of a force towards the axis, which is ours: the paper has none."}};

}  // namespace coapt
