/// \file  The recorded noise of every oracle run, and the ceiling that follows from it.
///
/// The sample variance of n samples has a relative standard error that follows from the kurtosis
/// (moments.h). Both the recorded variance and the one that a test measures have such an error, s
/// together. Sample variances are positive and skewed to the right; they are taken as lognormal,
/// which has a heavier right tail than the normal distribution of the same s. The ceiling is
///
///   variance * exp(4.9 sqrt(ln(1 + s^2))):
///
/// another stream of random numbers of the same quality exceeds it with a probability of 5e-7.
/// Where single large samples make the spread of whole repetitions more than twice what the
/// kurtosis says, that spread is taken: such a run has not seen its tail. Pixels that share paths
/// may err alike: a block of them is taken for one.
#pragma once

#include "tests/support/oracle.h"

#include <map>
#include <span>
#include <string>

namespace plumb::test {

struct OracleNoise {
    std::uint64_t samples = 0; ///< of a test
    double variance = 0;       ///< of one sample, relative to the square of the mean
    double kurtosis = 1;       ///< of pixels
    double ceiling = 0;        ///< of the variance that a test measures; infinite: none
    double max_over_mean = 0;  ///< largest seen
};

/// As the table's file has it, but for the name.
[[nodiscard]] std::string line_of(const OracleNoise& noise);

/// Reads the table. Throws std::runtime_error where a line is not understood or nothing is there.
[[nodiscard]] std::map<std::string, OracleNoise> read_oracle_noise(const std::string& file);

/// Samples that a test of a run needs whose moments are like those of `pilot`: that a bias of 1 %
/// is five standard errors, of what is shared too in the channel where that shows most; and that
/// the variance is known well enough to see a fifth more of it, up to 2^19.
[[nodiscard]] std::uint64_t samples_for(const OracleRun& run, const RelativeSamples& pilot);

/// What repetitions of a test of `samples` samples, of different seeds, say together.
[[nodiscard]] OracleNoise noise_of(std::span<const RelativeSamples> repetitions,
                                   std::uint64_t samples);

} // namespace plumb::test
