// What a joint's confidence stands for.
#pragma once

namespace understudy {

/// Confidence, 0..1, of a joint that is expected to be off by so many metres: one half at 0.06.
float confidence_for(float expected_error_m);
/// The error that a confidence stands for, metres.
float expected_error_for(float confidence);

}  // namespace understudy
