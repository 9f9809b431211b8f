// Writes what is reckoned of the cells of groups, block by block. Internal linkage: see cell_lanes_kernel.h.
#pragma once

#include "tables/group_block_kernel.h"

#include <cstring>

namespace {

class GroupCellsWriter {
public:
    explicit GroupCellsWriter(const acdf::GroupCells& of)
        : of_(of),
          gatherer_(of.environment, *this), grid_{of.heights,
                                                  of.sines,
                                                  static_cast<double>(of.environment.columns),
                                                  static_cast<double>(of.environment.rows),
                                                  {2.0 * ACDF_PI / of.environment.columns,
                                                   2.0 * ACDF_PI / of.environment.rows},
                                                  of.environment.parameterization == ACDF_PARAM_OCTAHEDRAL},
          boxes_(of.boxes), more_(of.more), cells_(of.cells), densities_(of.densities), left_(of.cell_count) {}

    void write() {
        for (std::size_t i = 0; i < of_.count; ++i) {
            const acdf::GroupRun& run = of_.runs[i];
            const acdf::GroupCurve& curve = of_.curves[run.curve];
            gatherer_.gather(static_cast<std::uint32_t>(i), curve.at, acdf_curve_at(of_.environment.tree, curve.at),
                             curve.above, run.first, run.last);
        }
        gatherer_.put_blocks();
    }

    void put(const CellLanes& lanes) {
        const AcdfGroup& group = of_.groups[lanes.group];
        const auto count = static_cast<std::size_t>(lanes.count);
        std::uint32_t*& boxes = lanes.group >= begun_ ? boxes_ : more_;
        const bool room = left_ >= kCellLanes; // what is behind the cells is written next
        reckon_group_lanes(grid_, group, lanes, heights_,
                           {room ? cells_ : last_cells_, room ? densities_ : last_densities_,
                            reinterpret_cast<std::uint8_t*>(boxes)});
        if (!room) {
            std::memcpy(cells_, last_cells_, count * sizeof *cells_);
            std::memcpy(densities_, last_densities_, count * sizeof *densities_);
        }
        boxes += ACDF_GROUP_WORDS;
        begun_ = lanes.group + 1;
        cells_ += count;
        densities_ += count;
        left_ -= count;
    }

private:
    const acdf::GroupCells& of_;
    LaneGatherer<GroupCellsWriter> gatherer_;
    const GroupGrid grid_;
    std::uint32_t *boxes_, *more_; // of the next group, of the next block of others
    AcdfGroupCell* cells_;
    float* densities_;
    std::size_t left_;        // cells
    std::uint32_t begun_ = 0; // groups
    GroupHeights heights_;
    AcdfGroupCell last_cells_[kCellLanes];
    float last_densities_[kCellLanes];
};

} // namespace
