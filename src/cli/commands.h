// SPDX-License-Identifier: MIT
// The commands behind the command line; each returns the exit status and throws what main.cpp maps to one.
#pragma once

#include "cli/options.h"

namespace fragtrace {

int runRender(const RenderOptions& options);
int runView(const ViewOptions& options);
int runInfo(const InfoOptions& options);
int runDiff(const DiffOptions& options);
int runMerge(const MergeOptions& options);
int runDenoise(const DenoiseOptions& options);
int runBenchError(const BenchErrorOptions& options);
int runBenchFrame(const BenchFrameOptions& options);
int runBenchReport(const BenchReportOptions& options);
int runBenchVariants(const BenchVariantsOptions& options);
int runBenchScale(const BenchScaleOptions& options);
int runBenchTraversal(const BenchTraversalOptions& options);
int runBenchStart(const BenchStartOptions& options);
int runBenchStress(const BenchStressOptions& options);

}  // namespace fragtrace
