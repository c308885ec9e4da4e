#include "soft_tissue_sim/base/cpu.h"

#include <cstdlib>
#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
InstructionSet best()
{
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                  __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  return v4 ? InstructionSet::x86_64_v4 : v3 ? InstructionSet::x86_64_v3 : InstructionSet::baseline;
#else
  return InstructionSet::baseline;
#endif
}

InstructionSet fromEnvironment()
{
  const char* text = std::getenv("SOFT_TISSUE_ISA");
  if (text == nullptr || *text == '\0')
  {
    return best();
  }
  for (const InstructionSet set :
       {InstructionSet::baseline, InstructionSet::x86_64_v3, InstructionSet::x86_64_v4})
  {
    if (std::string(text) == name(set))
    {
      if (set > best())
      {
        throw Error(std::string("SOFT_TISSUE_ISA = ") + text + ": this machine only has " +
                    name(best()));
      }
      return set;
    }
  }
  throw Error(std::string("SOFT_TISSUE_ISA = ") + text + ", must be baseline, v3 or v4");
}

InstructionSet& current()
{
  static InstructionSet set = fromEnvironment();
  return set;
}
}  // namespace

InstructionSet instructionSet()
{
  return current();
}

void forceInstructionSet(InstructionSet set)
{
  if (set > best())
  {
    throw Error(std::string("instruction set ") + name(set) + ": this machine only has " +
                name(best()));
  }
  current() = set;
}

const char* name(InstructionSet set)
{
  switch (set)
  {
    case InstructionSet::x86_64_v3:
      return "v3";
    case InstructionSet::x86_64_v4:
      return "v4";
    default:
      return "baseline";
  }
}

}  // namespace soft_tissue
