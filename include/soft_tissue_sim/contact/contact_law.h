#pragma once

namespace soft_tissue
{
/** What a depth costs. */
enum class ContactLaw
{
  pressure,    ///< stiffness times depth is a pressure: does not depend on the mesh
  fisher2001,  ///< each node pays k d^2, k in N/m. Source: [Fisher2001] eq. 1
  /** Each node feels k d, k in N/m, or each edge the integral of k d along it, k in N/m^2.
   * Source: [Marchal2004] section 5 */
  marchal2004,
};

}  // namespace soft_tissue
