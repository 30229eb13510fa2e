#include "app/applications/ice/floe_world.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <btBulletDynamicsCommon.h>

#include <glm/geometric.hpp>

namespace lumorph::ice {
namespace {

/// Bullet's margins and thresholds are made for things of about one unit, so its unit is the centimetre.
constexpr double kUnits = 100.0;
constexpr double kTall = 0.04;        ///< of prisms, metres: what presses them together never lifts one over the other
constexpr double kBank = 0.03;        ///< thickness of the bank, metres
constexpr btScalar kMargin = 0.004F;  ///< units by which corners are rounded
constexpr double kMostSpeed = 0.10;   ///< metres a second
constexpr double kMostSpin = 2.0;     ///< radians a second
constexpr btScalar kDrag = 0.45F;     ///< share of its speed that a floe loses in a second
constexpr double kLeastBump = 0.2e-6; ///< cubic metres a second

btVector3 toBullet(const glm::dvec2& v, double y = 0.0) {
    return {static_cast<btScalar>(kUnits * v.x), static_cast<btScalar>(kUnits * y),
            static_cast<btScalar>(kUnits * v.y)};
}

glm::dvec2 fromBullet(const btVector3& v) {
    return glm::dvec2(static_cast<double>(v.x()), static_cast<double>(v.z())) / kUnits;
}

std::unique_ptr<btConvexHullShape> prism(const Polygon& piece, const glm::dvec2& centre) {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const glm::dvec2& corner : piece)
        for (const double y : {-0.5 * kTall, 0.5 * kTall}) hull->addPoint(toBullet(corner - centre, y), false);
    hull->setMargin(kMargin);
    hull->recalcLocalAabb();
    return hull;
}

btTransform transformOf(const Placement& placement, const glm::dvec2& centre) {
    btTransform at;
    at.setIdentity();
    at.setRotation(btQuaternion(btVector3(0, -1, 0), static_cast<btScalar>(placement.turn)));
    at.setOrigin(toBullet(placed(placement, centre)));
    return at;
}

/// A body with its shape, and what Bullet does not know of it.
struct Body {
    std::vector<std::unique_ptr<btConvexHullShape>> prisms;
    std::unique_ptr<btCompoundShape> shape;
    std::unique_ptr<btRigidBody> rigid;
    glm::dvec2 centre{0.0}; ///< of its mass, home coordinates
    bool fixed = false;
};

struct Mass {
    double area = 0.0;
    glm::dvec2 centre{0.0};
    double inertia = 0.0; ///< about the vertical through its centre, over its density: metres to the fourth
};

Mass massOf(std::span<const Polygon> pieces) {
    Mass mass;
    for (const Polygon& piece : pieces) {
        mass.area += areaOf(piece);
        mass.centre += areaOf(piece) * centreOf(piece);
    }
    mass.centre /= std::max(mass.area, 1e-12);
    for (const Polygon& piece : pieces) {
        const double area = areaOf(piece);
        const glm::dvec2 from = centreOf(piece) - mass.centre;
        mass.inertia += area * (glm::dot(from, from) + area / 6.0); // each as a square
    }
    return mass;
}

} // namespace

struct FloeWorld::Data {
    explicit Data(const Polygon& shore) {
        world.getSolverInfo().m_numIterations = 16;
        world.getDispatchInfo().m_deterministicOverlappingPairs = true;
        world.setGravity({0, 0, 0});
        for (std::size_t k = 0; k < shore.size(); ++k) addBank(shore[k], shore[(k + 1) % shore.size()]);
    }
    ~Data() {
        for (const auto& [number, body] : bodies) world.removeRigidBody(body.rigid.get());
        for (const Body& body : banks) world.removeRigidBody(body.rigid.get());
    }
    Data(const Data&) = delete;
    Data& operator=(const Data&) = delete;

    void addBank(const glm::dvec2& from, const glm::dvec2& to) {
        const HalfPlane water = insideOf(from, to, 0.0);
        const glm::dvec2 out = kBank * water.normal, along = kBank * glm::normalize(to - from);
        const Polygon bank{from - along, from - along + out, to + along + out, to + along};
        banks.push_back(made(std::span(&bank, 1), {}, true));
        banks.back().rigid->setUserIndex(-1);
        world.addRigidBody(banks.back().rigid.get());
    }

    static void shape(Body& body, std::span<const Polygon> pieces, const glm::dvec2& centre) {
        body.centre = centre;
        body.shape = std::make_unique<btCompoundShape>(true, static_cast<int>(pieces.size()));
        body.prisms.clear();
        btTransform still;
        still.setIdentity();
        for (const Polygon& piece : pieces) {
            body.prisms.push_back(prism(piece, centre));
            body.shape->addChildShape(still, body.prisms.back().get());
        }
    }

    static Body made(std::span<const Polygon> pieces, const FloeMotion& motion, bool fixed) {
        const Mass mass = massOf(pieces);
        Body body;
        body.fixed = fixed;
        shape(body, pieces, mass.centre);
        btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, body.shape.get());
        info.m_startWorldTransform = transformOf(motion.placement, mass.centre);
        info.m_friction = 0.15F;
        info.m_restitution = 0.15F;
        info.m_linearDamping = kDrag;
        info.m_angularDamping = kDrag;
        body.rigid = std::make_unique<btRigidBody>(info);
        weigh(body, mass);
        body.rigid->setLinearFactor({1, 0, 1});
        body.rigid->setAngularFactor(btVector3(0, 1, 0));
        body.rigid->setActivationState(DISABLE_DEACTIVATION);
        body.rigid->setLinearVelocity(toBullet(motion.velocity));
        body.rigid->setAngularVelocity({0, static_cast<btScalar>(-motion.spin), 0});
        return body;
    }

    /// By area: a square unit weighs one.
    static void weigh(Body& body, const Mass& mass) {
        if (body.fixed) return;
        const auto weight = static_cast<btScalar>(kUnits * kUnits * mass.area);
        const auto inertia = static_cast<btScalar>(std::pow(kUnits, 4.0) * mass.inertia);
        body.rigid->setMassProps(weight, {inertia, inertia, inertia});
        body.rigid->updateInertiaTensor();
    }

    void limitSpeed(btRigidBody& rigid) const {
        const btVector3 velocity = rigid.getLinearVelocity();
        const auto most = static_cast<btScalar>(kUnits * kMostSpeed);
        if (velocity.length() > most) rigid.setLinearVelocity(velocity * (most / velocity.length()));
        const auto spin = std::clamp(static_cast<double>(rigid.getAngularVelocity().y()), -kMostSpin, kMostSpin);
        rigid.setAngularVelocity({0, static_cast<btScalar>(spin), 0});
    }

    void readBumps() {
        bumps.clear();
        for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
            const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
            FloeBump bump{manifold.getBody0()->getUserIndex(), manifold.getBody1()->getUserIndex(), {}, {}};
            double strongest = 0.0;
            for (int c = 0; c < manifold.getNumContacts(); ++c) {
                const btManifoldPoint& point = manifold.getContactPoint(c);
                const double impulse = static_cast<double>(point.getAppliedImpulse()) / std::pow(kUnits, 3.0);
                bump.impulse -= impulse * glm::dvec2(point.m_normalWorldOnB.x(), point.m_normalWorldOnB.z());
                if (impulse <= strongest) continue;
                strongest = impulse;
                bump.place = fromBullet(point.getPositionWorldOnB());
            }
            if (strongest > kLeastBump) bumps.push_back(bump);
        }
        // Manifolds stand in the order in which pairs met, which is the same in every run.
    }

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    std::vector<Body> banks;
    std::map<int, Body> bodies;
    std::vector<FloeBump> bumps;
    int next = 0;
};

FloeWorld::FloeWorld(const Polygon& shore) : data_(std::make_unique<Data>(shore)) {}
FloeWorld::~FloeWorld() = default;
FloeWorld::FloeWorld(FloeWorld&&) noexcept = default;
FloeWorld& FloeWorld::operator=(FloeWorld&&) noexcept = default;

int FloeWorld::add(std::span<const Polygon> pieces, const FloeMotion& motion, bool fixed) {
    const int number = data_->next++;
    Body& body = data_->bodies.emplace(number, Data::made(pieces, motion, fixed)).first->second;
    body.rigid->setUserIndex(number);
    data_->world.addRigidBody(body.rigid.get());
    return number;
}

void FloeWorld::reshape(int number, std::span<const Polygon> pieces) {
    Body& body = data_->bodies.at(number);
    FloeMotion kept = motion(number);
    const glm::dvec2 centre = placed(kept.placement, massOf(pieces).centre);
    kept.velocity = velocityAt(number, centre);
    data_->world.removeRigidBody(body.rigid.get());
    body = Data::made(pieces, kept, body.fixed);
    body.rigid->setUserIndex(number);
    data_->world.addRigidBody(body.rigid.get());
}

void FloeWorld::remove(int number) {
    data_->world.removeRigidBody(data_->bodies.at(number).rigid.get());
    data_->bodies.erase(number);
}

void FloeWorld::clear() {
    while (!data_->bodies.empty()) remove(data_->bodies.begin()->first);
    data_->solver.reset();
    data_->bumps.clear();
}

void FloeWorld::push(int number, const glm::dvec2& acceleration) {
    btRigidBody& rigid = *data_->bodies.at(number).rigid;
    if (rigid.getInvMass() > 0) rigid.applyCentralForce(toBullet(acceleration) / rigid.getInvMass());
}

void FloeWorld::step() {
    for (auto& [number, body] : data_->bodies)
        if (!body.fixed) data_->limitSpeed(*body.rigid);
    // One step of just this length, without the world's own accumulator.
    data_->world.stepSimulation(static_cast<btScalar>(kStep), 0);
    data_->readBumps();
}

FloeMotion FloeWorld::motion(int number) const {
    const Body& body = data_->bodies.at(number);
    const btTransform& at = body.rigid->getWorldTransform();
    FloeMotion motion;
    motion.placement.turn =
        std::atan2(static_cast<double>(at.getBasis()[2][0]), static_cast<double>(at.getBasis()[0][0]));
    motion.placement.shift = fromBullet(at.getOrigin()) - placed({{}, motion.placement.turn}, body.centre);
    motion.velocity = fromBullet(body.rigid->getLinearVelocity());
    motion.spin = -static_cast<double>(body.rigid->getAngularVelocity().y());
    return motion;
}

glm::dvec2 FloeWorld::velocityAt(int number, const glm::dvec2& place) const {
    const FloeMotion now = motion(number);
    const glm::dvec2 from = place - placed(now.placement, data_->bodies.at(number).centre);
    return now.velocity + now.spin * glm::dvec2(-from.y, from.x);
}

const std::vector<FloeBump>& FloeWorld::bumps() const noexcept { return data_->bumps; }

} // namespace lumorph::ice
