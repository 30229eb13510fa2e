#include "app/applications/labyrinth/ball_world.h"

#include <algorithm>
#include <cmath>

#include <btBulletDynamicsCommon.h>

namespace lumorph::labyrinth {
namespace {

/// Bullet's margins and thresholds are made for things of about one unit, so its unit is the centimetre.
constexpr double kUnits = 100.0;
constexpr double kCeiling = 0.05;    ///< metres over the sheet; nothing a ball does leads there
constexpr double kMostSpeed = 0.7;   ///< metres a second: less than a radius a step
constexpr btScalar kMargin = 0.002F; ///< units by which edges are rounded: seams between blocks stay shallow
constexpr btScalar kSide = 0.7F;     ///< normals that rise less are of sides

btVector3 toBullet(const glm::dvec3& v) {
    const glm::dvec3 units = kUnits * v;
    return {static_cast<btScalar>(units.x), static_cast<btScalar>(units.y), static_cast<btScalar>(units.z)};
}

glm::dvec3 fromBullet(const btVector3& v) {
    return glm::dvec3(static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())) / kUnits;
}

std::unique_ptr<btCollisionShape> shapeOf(const Block& block) {
    auto hull = std::make_unique<btConvexHullShape>();
    for (std::size_t k = 0; k < 4; ++k) {
        const double top = block.kind == Block::Kind::wall ? kCeiling : block.tops[k];
        for (const double y : {block.bottom, top})
            hull->addPoint(toBullet({block.outline[k].x, y, block.outline[k].y}), false);
    }
    hull->recalcLocalAabb();
    hull->setMargin(kMargin);
    return hull;
}

} // namespace

struct BallWorld::Data {
    Data(const Level& level, const std::vector<Block>& blocks) {
        world.getSolverInfo().m_numIterations = 20;
        world.getDispatchInfo().m_deterministicOverlappingPairs = true;
        for (const Block& block : blocks) addStatic(shapeOf(block), {0.0, 0.0, 0.0});
        const glm::dvec2 half = 0.5 * level.cell * glm::dvec2(level.columns, level.rows);
        addStatic(std::make_unique<btBoxShape>(toBullet({half.x, 0.005, half.y})), {0.0, kCeiling + 0.005, 0.0});
        addBall();
    }
    ~Data() {
        for (const auto& body : bodies) world.removeRigidBody(body.get());
    }
    Data(const Data&) = delete;
    Data& operator=(const Data&) = delete;

    btRigidBody& add(std::unique_ptr<btCollisionShape> shape, btScalar mass, const glm::dvec3& at) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape->calculateLocalInertia(mass, inertia);
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(), inertia);
        info.m_startWorldTransform.setIdentity();
        info.m_startWorldTransform.setOrigin(toBullet(at));
        info.m_friction = 0.6F;
        shapes.push_back(std::move(shape));
        bodies.push_back(std::make_unique<btRigidBody>(info));
        world.addRigidBody(bodies.back().get());
        return *bodies.back();
    }

    void addStatic(std::unique_ptr<btCollisionShape> shape, const glm::dvec3& at) {
        add(std::move(shape), 0, at).setRestitution(0.8F);
    }

    void addBall() {
        const auto radius = static_cast<btScalar>(kUnits * kBallRadius);
        ball = &add(std::make_unique<btSphereShape>(radius), 1, {0.0, 0.02, 0.0});
        ball->setRestitution(0.45F);
        ball->setDamping(0.12F, 0.12F);
        ball->setActivationState(DISABLE_DEACTIVATION);
        ball->setCcdMotionThreshold(0.3F * radius);
        ball->setCcdSweptSphereRadius(0.5F * radius);
    }

    void read() {
        const btTransform& at = ball->getWorldTransform();
        const btQuaternion turn = at.getRotation();
        state.position = fromBullet(at.getOrigin());
        state.velocity = fromBullet(ball->getLinearVelocity());
        state.rotation = {static_cast<double>(turn.w()), static_cast<double>(turn.x()), static_cast<double>(turn.y()),
                          static_cast<double>(turn.z())};
    }

    void limitSpeed() {
        const btVector3 velocity = ball->getLinearVelocity();
        const auto most = static_cast<btScalar>(kUnits * kMostSpeed);
        if (velocity.length() > most) ball->setLinearVelocity(velocity * (most / velocity.length()));
    }

    /// What the ball met in the last step.
    void readContacts() {
        onGround = false;
        bump = 0.0;
        for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
            const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
            const btScalar sign = manifold.getBody0() == ball ? 1.0F : -1.0F;
            for (int c = 0; c < manifold.getNumContacts(); ++c) {
                const btManifoldPoint& point = manifold.getContactPoint(c);
                if (point.getAppliedImpulse() <= 0) continue;
                if (sign * point.m_normalWorldOnB.y() > kSide)
                    onGround = true;
                else
                    bump = std::max(bump, static_cast<double>(point.getAppliedImpulse()) / kUnits); // of mass 1
            }
        }
    }

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    std::vector<std::unique_ptr<btCollisionShape>> shapes;
    std::vector<std::unique_ptr<btRigidBody>> bodies;
    btRigidBody* ball = nullptr; ///< among `bodies`
    Ball state;
    bool onGround = false;
    double bump = 0.0;
};

BallWorld::BallWorld(const Level& level, const std::vector<Block>& blocks)
    : data_(std::make_unique<Data>(level, blocks)) {}
BallWorld::~BallWorld() = default;
BallWorld::BallWorld(BallWorld&&) noexcept = default;
BallWorld& BallWorld::operator=(BallWorld&&) noexcept = default;

void BallWorld::place(const glm::dvec3& position) {
    btTransform at;
    at.setIdentity();
    at.setOrigin(toBullet(position));
    btRigidBody& ball = *data_->ball;
    ball.setWorldTransform(at);
    ball.setInterpolationWorldTransform(at);
    ball.setLinearVelocity({0, 0, 0});
    ball.setAngularVelocity({0, 0, 0});
    ball.setInterpolationLinearVelocity({0, 0, 0});
    ball.setInterpolationAngularVelocity({0, 0, 0});
    ball.clearForces();
    data_->broadphase.getOverlappingPairCache()->cleanProxyFromPairs(ball.getBroadphaseHandle(), &data_->dispatcher);
    data_->solver.reset();
    data_->onGround = false;
    data_->bump = 0.0;
    data_->read();
}

void BallWorld::step(const glm::dvec3& gravity) {
    data_->ball->setGravity(toBullet(gravity));
    data_->limitSpeed();
    // One step of just this length, without the world's own accumulator.
    data_->world.stepSimulation(static_cast<btScalar>(kStep), 0);
    data_->readContacts();
    data_->read();
}

const Ball& BallWorld::ball() const noexcept { return data_->state; }
bool BallWorld::onGround() const noexcept { return data_->onGround; }
double BallWorld::bump() const noexcept { return data_->bump; }

} // namespace lumorph::labyrinth
