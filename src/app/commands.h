// One function and one file a command; each returns the exit status.
#pragma once
#include "app/command_line.h"

namespace smokebox {

int runRender(const RenderOptions& options);
int runSimulate(const SimulateOptions& options);
int runCompare(const CompareOptions& options);
int runDiff(const DiffOptions& options);
int runCheck(const CheckOptions& options);
int runPlan(const PlanOptions& options);

}  // namespace smokebox
