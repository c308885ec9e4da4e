#pragma once

namespace soft_tissue
{
/** Instruction sets that hot kernels are built for. All give the same bits. */
enum class InstructionSet
{
  baseline,   ///< plain x86-64 (or whatever the compiler's default is)
  x86_64_v3,  ///< AVX2
  x86_64_v4,  ///< AVX-512
};

/** The best set this machine has, or the one forced. */
InstructionSet instructionSet();

/**
 * Forces a set for kernels chosen from now on; used by tests and by the environment variable
 * SOFT_TISSUE_ISA = baseline | v3 | v4, read at the first call of instructionSet().
 * @throws Error when the machine can't run it
 */
void forceInstructionSet(InstructionSet set);

const char* name(InstructionSet set);

}  // namespace soft_tissue
