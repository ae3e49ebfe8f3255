// The tables of stages.
#include "stages.hpp"

namespace grainray {

const Stages cpu::stage_table{retire, sort, margins, list_pairs, list_walls, contacts, walls, integrate, nullptr, list_end, touching, list_figures, totals, quantile_x, hash, healthy, contact_fields,
                               list_facets, facets, surface_totals, hash_facets, facet_fields, residents, count_taken, take_out};

#ifdef GRAINRAY_HAS_CUDA
const Stages cuda::stage_table{retire, sort, margins, list_pairs, list_walls, nullptr, nullptr, nullptr, fused, list_end, touching, list_figures, totals, quantile_x, hash, healthy, contact_fields,
                               list_facets, facets, surface_totals, hash_facets, facet_fields, residents, count_taken, take_out};
#endif

}  // namespace grainray
