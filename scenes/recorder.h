// scenes/recorder.h - the results of a run on their way to the disk: frames, the time series, and who writes them when.
#pragma once
#include <memory>
#include <string>
#include "engine/io/output_folder.h"
#include "engine/io/statistics.h"
#include "engine/io/trajectory.h"
#include "engine/io/writer_thread.h"
#include "scenes/scene.h"
#include "tasks/sampling.h"

namespace skred {

// The row of statistics.csv of this moment.
StatisticsRow statistics_row(const Scene&, const Simulation&, const Measures&);

class Recorder {
 public:
  Recorder(const Scene&, Simulation&, const OutputFolder&);

  // Copies what is written; the writing itself happens on the writer's thread while the next steps run. Throw IoError if an
  // earlier write failed. Of one step, only the first frame and the first row are written.
  void frame();
  const Measures& statistics();
  void finish();                                   // writes all that waits; throws IoError

  std::int64_t frames() const { return frames_; }

 private:
  const Scene& scene_;
  Simulation& sim_;
  KernelId sample_, copy_, write_;
  Measures last_;
  std::shared_ptr<TrajectoryWriter> trajectory_;
  std::shared_ptr<StatisticsWriter> series_;
  std::int64_t frames_ = 0, last_frame_step_ = -1, last_row_step_ = -1;
  Ticks job_begin_ = 0;
  WriterThread writer_;                            // last: its jobs use the others
};

}  // namespace skred
