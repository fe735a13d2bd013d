/* holefill.h alone, first and twice, in the language that the target is compiled as. */
#include <holefill.h>
#include <holefill.h>

extern uint32_t header_only_use(void);

uint32_t header_only_use(void) {
    const HolefillFillOptions options = HOLEFILL_FILL_OPTIONS_INIT;
    const HolefillSelection selection = HOLEFILL_SELECTION_INIT;
    const HolefillTarget target = HOLEFILL_TARGET_INIT;
    const HolefillMeshInfo mesh = HOLEFILL_MESH_INFO_INIT;
    const HolefillDefects defects = HOLEFILL_DEFECTS_INIT;
    const HolefillAttributeInfo attribute = HOLEFILL_ATTRIBUTE_INFO_INIT;
    const HolefillLoopInfo loop = HOLEFILL_LOOP_INFO_INIT;
    const HolefillPointOptions points = HOLEFILL_POINT_OPTIONS_INIT;
    const HolefillPointSummary became = HOLEFILL_POINT_SUMMARY_INIT;
    const HolefillPatchInfo patch = HOLEFILL_PATCH_INFO_INIT;
    const HolefillHole hole = HOLEFILL_HOLE_INIT;
    const HolefillPrediction prediction = HOLEFILL_PREDICTION_INIT;
    const HolefillSummary summary = HOLEFILL_SUMMARY_INIT;
    const HolefillInput input = HOLEFILL_INPUT_INIT;
    const HolefillOutput output = HOLEFILL_OUTPUT_INIT;
    return options.struct_size + selection.struct_size + target.struct_size + mesh.struct_size + defects.struct_size +
           attribute.struct_size + loop.struct_size + points.struct_size + became.struct_size + patch.struct_size +
           hole.struct_size + prediction.struct_size + summary.struct_size + input.scalar_type + output.scalar_type;
}
