// SPDX-License-Identifier: MIT
// Binary glTF as written, read by assimp: the animation has the bodies where the curved path has them.
#include "design/exports/glb_writer.hpp"

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "design/exports/palette.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_models.hpp"

namespace fettle::design::exports::glb_writer_test {

namespace {

using core::kinematics::ChartPoint;
using core::kinematics::Pose;
using core::stepper::Trajectory;
using tests::support::box_mesh;
using tests::support::make_body;
using tests::support::make_pose;
using tests::support::TemporaryFolder;

struct Moving {
    core::model::Model model;
    Trajectory path;
};

/// A body that tumbles over nodes whose rotation vectors do not lie in line, a large turn, and one that stays.
Moving tumbling() {
    Moving out;
    out.model.length_unit = 1e-3;
    out.model.gravity = Vector3(0, 0, -9.81);
    out.model.bodies = {
        make_body("frame", box_mesh(Vector3(-0.05, -0.05, -0.01), Vector3(0.05, 0.05, 0)), make_pose({0, 0, 0}, {0, 0, -0.1})),
        make_body("arm", box_mesh(Vector3(-0.02, -0.01, -0.01), Vector3(0.03, 0.01, 0.01)), make_pose({0, 0, 0.4}, {0.01, 0, 0.2}))};
    Trajectory& path = out.path;
    path.timestep = 0.1;
    path.body_names = {"frame", "arm"};
    std::vector<Pose> poses{out.model.bodies[0].pose_start, out.model.bodies[1].pose_start};
    path.poses = {poses};
    const std::vector<std::vector<Vector3>> turns{{Vector3(0, 0, 0), Vector3(0, 0, 2.9)},
                                                  {Vector3(0, 0, 0), Vector3(0.8, 0.2, 0), Vector3(0.5, -0.6, 0.9)}};
    for (std::size_t t = 0; t < turns.size(); ++t) {
        core::stepper::TrajectoryStep step;
        for (std::size_t k = 0; k < turns[t].size(); ++k)
            step.nodes.push_back(
                {{poses[0].position, Vector3::Zero()},
                 {poses[1].position + 0.02 * static_cast<double>(k) * Vector3(1, 0.5, static_cast<double>(t)), turns[t][k]}});
        path.steps.push_back(step);
        poses[1] = {core::kinematics::rotation(turns[t].back()) * poses[1].rotation, step.nodes.back()[1].position};
        path.poses.push_back(poses);
    }
    return out;
}

struct Imported {
    const aiScene* scene;
    explicit Imported(const std::string& path) : scene(aiImportFile(path.c_str(), 0)) {
        INFO(aiGetErrorString());
        REQUIRE(scene != nullptr);
    }
    ~Imported() { aiReleaseImport(scene); }
    Imported(const Imported&) = delete;
    Imported& operator=(const Imported&) = delete;
};

const aiNode* find_node(const aiNode* node, const std::string& name) {
    if (node->mName.C_Str() == name) return node;
    for (unsigned i = 0; i < node->mNumChildren; ++i)
        if (const aiNode* found = find_node(node->mChildren[i], name)) return found;
    return nullptr;
}

/// The blue of the base colour.
float blue(const aiMaterial& material) {
    for (unsigned i = 0; i < material.mNumProperties; ++i) {
        const aiMaterialProperty& property = *material.mProperties[i];
        if (std::string(property.mKey.C_Str()) == "$clr.base") return reinterpret_cast<const float*>(property.mData)[2];
    }
    return -1;
}

Eigen::Quaterniond quaternion(const aiQuaternion& q) { return {q.w, q.x, q.y, q.z}; }

/// What a viewer shows at a time: LINEAR is straight, and slerp.
Pose sampled(const aiNodeAnim& channel, double ticks) {
    unsigned k = 0;
    while (k + 2 < channel.mNumPositionKeys && channel.mPositionKeys[k + 1].mTime < ticks) ++k;
    const auto &p0 = channel.mPositionKeys[k], &p1 = channel.mPositionKeys[k + 1];
    const auto &r0 = channel.mRotationKeys[k], &r1 = channel.mRotationKeys[k + 1];
    const double s = std::clamp((ticks - p0.mTime) / (p1.mTime - p0.mTime), 0.0, 1.0);
    const Vector3 a(p0.mValue.x, p0.mValue.y, p0.mValue.z), b(p1.mValue.x, p1.mValue.y, p1.mValue.z);
    return {quaternion(r0.mValue).slerp(s, quaternion(r1.mValue)).normalized().toRotationMatrix(), a + s * (b - a)};
}

}  // namespace

TEST_CASE("GLB: assimp reads names, meshes, colours, and the root turns Z up to Y up") {
    const TemporaryFolder folder;
    const Moving moving = tumbling();
    const Assembly assembly = assembly_of(moving.model, moving.path);
    const Imported read(folder.write("a.glb", glb_bytes(assembly)));
    const aiNode* root = find_node(read.scene->mRootNode, "fettle");
    REQUIRE(root != nullptr);
    const aiVector3D up = root->mTransformation * aiVector3D(0, 0, 1);
    CHECK((up - aiVector3D(0, 1, 0)).Length() < 1e-6F);
    REQUIRE(read.scene->mNumMeshes == 2);
    const std::vector<Colour> colours = part_colours(moving.model);
    CHECK(colours[0] != colours[1]);
    for (int b = 0; b < 2; ++b) {
        const aiNode* node = find_node(read.scene->mRootNode, moving.model.bodies[b].name);
        REQUIRE(node != nullptr);
        CHECK(node->mParent == root);
        REQUIRE(node->mNumMeshes == 1);
        const aiMesh& mesh = *read.scene->mMeshes[node->mMeshes[0]];
        CHECK(mesh.mNumFaces == 12);
        const auto& own = moving.model.bodies[b].mesh;
        double largest = 0;
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            for (unsigned k = 0; k < 3; ++k) {
                const aiVector3D& x = mesh.mVertices[mesh.mFaces[f].mIndices[k]];
                const Vector3 wanted = own.vertices.col(own.triangles[f][k]);
                largest = std::max(largest, (Vector3(x.x, x.y, x.z) - wanted).norm());
            }
        }
        CHECK(largest < 1e-8);
        const double shade = colours[b][2] / 255.0;
        const double light = shade <= 0.04045 ? shade / 12.92 : std::pow((shade + 0.055) / 1.055, 2.4);  // sRGB to linear
        CHECK(blue(*read.scene->mMaterials[mesh.mMaterialIndex]) == Approx(light).margin(1e-3));
    }
}

TEST_CASE("GLB: between keys too, the animation follows the curved path") {
    const TemporaryFolder folder;
    const Moving moving = tumbling();
    const Imported read(folder.write("a.glb", glb_bytes(assembly_of(moving.model, moving.path))));
    REQUIRE(read.scene->mNumAnimations == 1);
    const aiAnimation& animation = *read.scene->mAnimations[0];
    REQUIRE(animation.mNumChannels == 1);  // the frame stays
    const aiNodeAnim& channel = *animation.mChannels[0];
    CHECK(std::string(channel.mNodeName.C_Str()) == "arm");
    REQUIRE(channel.mNumPositionKeys == channel.mNumRotationKeys);
    const double ticks = animation.mTicksPerSecond;
    double turn = 0, shift = 0;
    for (int t = 0; t < 2; ++t) {
        for (int k = 0; k < core::stepper::segment_count(moving.path, t); ++k) {
            for (int i = 0; i <= 40; ++i) {
                const Pose wanted = core::stepper::pose_at(moving.path, t, k, i / 40.0, 1);
                const Pose found = sampled(channel, ticks * core::stepper::time_at(moving.path, t, k, i / 40.0));
                turn = std::max(turn, (found.rotation - wanted.rotation).cwiseAbs().maxCoeff());
                shift = std::max(shift, (found.position - wanted.position).norm());
            }
        }
    }
    CAPTURE(turn, shift, channel.mNumPositionKeys);
    CHECK(turn < 5e-6);
    CHECK(shift < 1e-7);
}

TEST_CASE("GLB: without a motion no animation; up as gravity has it; copies share their vertices") {
    Moving moving = tumbling();
    moving.path.steps.clear();
    moving.path.poses.resize(1);
    moving.model.gravity = Vector3(0, -9.81, 0);
    moving.model.bodies[1].mesh = moving.model.bodies[0].mesh;
    const std::string bytes = glb_bytes(assembly_of(moving.model, moving.path));
    const std::size_t length = static_cast<unsigned char>(bytes[12]) + 256U * static_cast<unsigned char>(bytes[13]);
    const auto json = nlohmann::json::parse(bytes.substr(20, length));
    CHECK_FALSE(json.contains("animations"));
    CHECK(json["nodes"][0]["rotation"] == nlohmann::json({0.0, 0.0, 0.0, 1.0}));
    CHECK(json["meshes"].size() == 2);
    CHECK(json["accessors"].size() == 2);
    CHECK(json["meshes"][0]["primitives"][0]["attributes"] == json["meshes"][1]["primitives"][0]["attributes"]);
    CHECK(json["meshes"][0]["primitives"][0]["material"] != json["meshes"][1]["primitives"][0]["material"]);
    CHECK(json["buffers"][0]["byteLength"] == 8 * 12 + 36 * 4);
    CHECK(up_of({0, 0, 0}) == Vector3::UnitZ());
    CHECK(up_of({0.1, 3, 0}) == Vector3(0, -1, 0));
}

}  // namespace fettle::design::exports::glb_writer_test
