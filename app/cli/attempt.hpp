// Parts of a job that may fail without the whole failing: a case of many, a check of the doctor.
#pragma once

#include <exception>
#include <string>

namespace understudy::app {

/// Runs it; gives the sentence of what went wrong, empty when nothing did.
template <class Part>
std::string failure_of(Part part) {
  try {
    part();
    return {};
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace understudy::app
