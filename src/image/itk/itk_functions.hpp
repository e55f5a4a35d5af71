// What this room asks of ITK, as one table, for programs that load ITK when a volume image first needs it: its libraries
// take longer to load than a small valve to solve (docs/decisions/015-what-unused-components-cost.md). The
// functions are those of the headers; itk/forwarded.cpp defines them by this table, and a program without it links
// coapt_image_itk, which has the functions themselves.
#pragma once

#include "image/burlina/gradient_magnitude.hpp"
#include "image/burlina/thin_tissue.hpp"
#include "image/detail/image_io.hpp"
#include "image/routes/distance_from_sheet.hpp"
#include "image/segment/sheet_evidence.hpp"
#include "image/slices/slice_picture.hpp"
#include "image/write_volume.hpp"

namespace coapt {

struct ItkFunctions {
  decltype(&coapt::open_image) open_image = coapt::open_image;
  decltype(&coapt::dicom_series) dicom_series = coapt::dicom_series;
  decltype(&coapt::write_volume) write_volume = coapt::write_volume;
  decltype(&coapt::write_png) write_png = coapt::write_png;
  decltype(&coapt::gradient_magnitude) gradient_magnitude = coapt::gradient_magnitude;
  decltype(&coapt::thin_tissue) thin_tissue = coapt::thin_tissue;
  decltype(&coapt::distance_from_sheet) distance_from_sheet = coapt::distance_from_sheet;
  decltype(&coapt::without_speckle) without_speckle = coapt::without_speckle;
  decltype(&coapt::sheet_evidence) sheet_evidence = coapt::sheet_evidence;
  decltype(&coapt::otsu_threshold) otsu_threshold = coapt::otsu_threshold;
  decltype(&coapt::greatest_part) greatest_part = coapt::greatest_part;
};

// For itk/forwarded.cpp; of the program that loads ITK. Throws InputError where it cannot be loaded.
const ItkFunctions& itk_functions();

}  // namespace coapt
