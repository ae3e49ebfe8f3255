// The table of one executor's stages.
#include "stages.hpp"

#include "exec/exec.hpp"

namespace grainray::GRAINRAY_EXEC {

const Stages stage_table{sort, margins, wall_candidates, carry_pairs, carry_walls, contacts, walls, integrate,
                         facet_candidates, carry_facets, facets, count_lost};

}  // namespace grainray::GRAINRAY_EXEC
