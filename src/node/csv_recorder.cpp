#include "soft_tissue_sim/node/csv_recorder.h"

#include "contact_sums.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
CsvRecorder::CsvRecorder(const std::string& path, const SceneInfo& info)
    : path_(path), stream_(path)
{
  stream_.precision(17);
  stream_ << "step,time_s,newton_iterations,linear_iterations,residual,position_error_m,converged,"
             "parts,halvings,held,"
             "min_det_f,max_penetration_m,contacts,state_hash";
  for (const soft_tissue::ToolInfo& tool : info.tools)
  {
    for (const char* column :
         {"x_m", "y_m", "z_m", "qx", "qy", "qz", "qw", "force_x_n", "force_y_n", "force_z_n",
          "torque_x_nm", "torque_y_nm", "torque_z_nm", "depth_m", "contacts"})
    {
      stream_ << ',' << tool.name << '_' << column;
    }
  }
  for (const TissuePairInfo& pair : info.tissue_pairs)
  {
    for (const char* column : {"force_x_n", "force_y_n", "force_z_n", "depth_m", "contacts"})
    {
      stream_ << ',' << pair.name << '_' << column;
    }
  }
  stream_ << '\n';
  check();
}

void CsvRecorder::write(const soft_tissue::Snapshot& snapshot)
{
  const soft_tissue::StepReport& report = snapshot.report;
  stream_ << report.step << ',' << report.time_s << ',' << report.newton_iterations << ','
          << report.linear_iterations << ',' << report.residual << ',' << report.position_error_m
          << ',' << report.converged << ',' << report.parts << ',' << report.halvings << ','
          << report.held << ',' << report.min_det_f << ',' << report.max_penetration_m << ','
          << report.contacts << ',' << std::hex << snapshot.state_hash << std::dec;
  for (const soft_tissue::ToolState& tool : snapshot.tools)
  {
    writeTool(tool);
  }
  for (const soft_tissue::TissuePairState& pair : snapshot.tissue_pairs)
  {
    writePair(pair);
  }
  stream_ << '\n';
  check();
}

/** A full disk shows at once, not after a night. */
void CsvRecorder::check() const
{
  if (!stream_)
  {
    throw soft_tissue::Error("csv " + path_ + ": can't be written");
  }
}

void CsvRecorder::writeTool(const soft_tissue::ToolState& tool)
{
  const soft_tissue::Vec3 p = tool.X_WT.translation();
  const Eigen::Quaterniond q(tool.X_WT.linear());
  const soft_tissue::Vec3& force = tool.wrench_W.force;
  const soft_tissue::Vec3& torque = tool.wrench_W.torque;
  const double depth = sumOf(tool.contacts).deepest_m;
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(), force.x(), force.y(),
                             force.z(), torque.x(), torque.y(), torque.z(), depth})
  {
    stream_ << ',' << value;
  }
  stream_ << ',' << tool.contacts.size();
}

void CsvRecorder::writePair(const soft_tissue::TissuePairState& pair)
{
  const ContactSums sums = sumOf(pair.contacts);
  for (const double value : {sums.force_W.x(), sums.force_W.y(), sums.force_W.z(), sums.deepest_m})
  {
    stream_ << ',' << value;
  }
  stream_ << ',' << pair.contacts.size();
}

void CsvRecorder::close()
{
  stream_.close();
  if (!stream_)
  {
    throw soft_tissue::Error("csv " + path_ + ": can't be written to its end");
  }
}

}  // namespace soft_tissue_sim
