// The hard cases that tests/verify does not have, each with the test that covers it.
#pragma once

#include <array>
#include <string_view>

namespace whit::test {

// `test` is the full name in `file`, without the prefix of the instantiation.
struct Accounted {
  int number;
  std::string_view title, file, test;
};

inline constexpr std::array kAccounted{
    Accounted{11, "instances are their meshes, moved",
              "tests/reference/find_intersections_test.cpp", "Surfel.InstancesMatchBakedGeometry"},
    Accounted{23, "degenerate triangles are counted", "tests/unit/repairing_test.cpp",
              "Repairing.DegenerateTrianglesAreDroppedAndCounted"},
    Accounted{27, "bad corners are counted and refused by --strict",
              "tests/unit/repairing_test.cpp", "Repairing.BadVerticesTakeOnlyTheirTriangles"},
    Accounted{29, "random bits never reach the tables", "tests/unit/repairing_test.cpp",
              "Repairing.GarbageNeverReachesTheTables"},
    Accounted{31, "equal positions stay equal through transforms", "tests/unit/bake_test.cpp",
              "Bake.UnsharedVerticesStayTogether"},
    Accounted{34, "normals of no use become the face's", "tests/unit/repairing_test.cpp",
              "Repairing.NormalsOfNoUseBecomeTheFaces"},
    Accounted{51, "normalizing from the smallest to the largest float", "tests/unit/vec3_test.cpp",
              "Normalized.UnitLengthFromTheSmallestToTheLargestFloat"},
    Accounted{53, "true reciprocals and roots", "tests/render/stages_test.cpp",
              "StagesOfScenes.EveryStageAgreesWithItsReferenceOnEveryTarget"},
    Accounted{54, "contraction and targets", "tests/hard/image_hashes_test.cpp",
              "HashTest.IsThePublishedOne"},
    Accounted{55, "workers flush denormals, nobody else does", "tests/unit/worker_pool_test.cpp",
              "WorkerPool.H55_denormalsAreFlushedInEveryWorkerAndNowhereElse"},
    Accounted{57, "sky and image texels are repaired and counted", "tests/images/exr_test.cpp",
              "ExrTest.OddValuesAreMendedInTexturesOnly"},
    Accounted{67, "cones of spot lights, directional lights",
              "tests/reference/find_radiance_and_shadow_rays_test.cpp",
              "SpotCone.H67_fallsOffMonotonicallyBetweenItsCones"},
    Accounted{68, "far texture coordinates are recentered", "tests/unit/repairing_test.cpp",
              "Repairing.FarTextureCoordinatesAreRecenteredWhereTheyRepeat"},
    Accounted{69, "coordinates just below 0", "tests/reference/texture_sampling_test.cpp",
              "TextureSampling.TinyNegativeCoordinates"},
    Accounted{70, "footprints of no sense", "tests/reference/ray_cones_test.cpp",
              "MipLevel.H70_ofSenselessFootprintsIsALevel"},
    Accounted{70, "whole mip levels", "tests/reference/ray_cones_test.cpp",
              "Trilinear.H70_aWholeLevelIsThatLevelBitForBit"},
    Accounted{72, "every sRGB code comes back", "tests/images/display_test.cpp",
              "Srgb.EveryCodeComesBack"},
    Accounted{73, "halves are read; files are written as floats", "tests/images/exr_test.cpp",
              "ExrTest.HalvesAndAlphaAreRead"},
    Accounted{74, "image files come back", "tests/images/png_test.cpp", "PngTest.PixelsComeBack"},
    Accounted{75, "odd cameras give a picture", "tests/unit/camera_test.cpp",
              "CameraFrame.SenselessCamerasStillGiveAPicture"},
    Accounted{77, "a hundred rotations undone", "tests/unit/affine_test.cpp",
              "Affine.HundredNestedRotationsUndone"},
    Accounted{77, "transforms that flatten are refused", "tests/unit/validate_test.cpp",
              "Validate.RefusesNamingTheThingAtFault"},
    Accounted{78, "a real model", "tests/io/real_models_test.cpp",
              "Sponza.LoadsCompletelyForAnyNumberOfThreads"},
};

}  // namespace whit::test
