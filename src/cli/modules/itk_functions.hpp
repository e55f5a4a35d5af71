// What the command asks of ITK, as one table. In the module its entries are the functions of these headers;
// in the command loaded_itk.cpp defines these functions by calls through the table.
#pragma once

#include "image/burlina/thin_tissue.hpp"
#include "image/itk/gradient_magnitude.hpp"
#include "image/itk/image_io.hpp"
#include "image/routes/distance_from_sheet.hpp"
#include "image/segment/sheet_evidence.hpp"
#include "image/slices/slice_picture.hpp"
#include "image/write_volume.hpp"

namespace coapt::cli {

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

}  // namespace coapt::cli
