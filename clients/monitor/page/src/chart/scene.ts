// The chart in 3-D: seabed and contours (drawn once), vehicles (instanced), trails, wavefronts. Labels and marks are drawn by
// overlay.ts above it. Drawing space as in ground.ts.
import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, DynamicDrawUsage, InstancedMesh, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  MeshBasicMaterial, PerspectiveCamera, Quaternion, Scene, ShaderMaterial, Vector2, Vector3, WebGLRenderer,
} from "three";
import { MapControls } from "three/examples/jsm/controls/MapControls.js";
import type { Step } from "../parts/shedding";
import type { Packet, TerrainTile, VehicleInfo } from "../protocol";
import type { Instant } from "../store/frame_clock";
import {
  type Contours, type DepthRange, contourLines, depthRange, exaggeration, groundGeometry, groundPicture,
} from "./ground";
import type { Trails } from "./trails";

const VEHICLE_PIXELS = 11;
const MOST_WAVES = 16;
const WAVE_POINTS = 120;
const UP = new Vector3(0, 1, 0);

export interface Place { x: number; y: number; behind: boolean }

/** A dart that points north in the horizontal plane, a diamond for what stands. */
function outline(points: [number, number][]): BufferGeometry {
  const geometry = new BufferGeometry();
  const vertices = points.flatMap(([east, north]) => [east, 0, -north]);
  const index: number[] = [];
  for (let i = 1; i + 1 < points.length; ++i) index.push(0, i, i + 1);
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(vertices), 3));
  geometry.setIndex(index);
  return geometry;
}
const DART: [number, number][] = [[0, -0.45], [0.72, -0.95], [0, 1.25], [-0.72, -0.95]];
const DIAMOND: [number, number][] = [[0, -0.8], [0.8, 0], [0, 0.8], [-0.8, 0]];

/** Instances of one shape with a dark rim. */
class Markers {
  readonly meshes: [InstancedMesh, InstancedMesh];
  private capacity = 0;
  constructor(private scene: Scene, private geometry: BufferGeometry) {
    this.meshes = [this.make(1), this.make(1)];
  }
  private make(capacity: number, order = 10) {
    const material = new MeshBasicMaterial({ color: 0xffffff, side: DoubleSide, depthTest: false, depthWrite: false });
    const mesh = new InstancedMesh(this.geometry, material, capacity);
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.frustumCulled = false;
    mesh.renderOrder = order;
    mesh.count = 0;
    this.scene.add(mesh);
    return mesh;
  }
  reserve(n: number) {
    if (n <= this.capacity) return;
    for (const mesh of this.meshes) {
      this.scene.remove(mesh);
      mesh.dispose();
    }
    this.capacity = n;
    const rim = this.make(n, 10);
    (rim.material as MeshBasicMaterial).color.set(0x0c1215);
    this.meshes.splice(0, 2, rim, this.make(n, 11));
  }
}

interface Wave { mesh: Mesh<BufferGeometry, ShaderMaterial>; radii: { value: Vector3 } }

export class ChartScene {
  readonly camera = new PerspectiveCamera(32, 1, 1, 1e7);
  readonly controls: MapControls;
  contours: Contours | null = null;
  stretch = 1;
  extent_m = 2000;
  /** True while the renderer is a program on the processor. */
  readonly software: boolean;
  private renderer: WebGLRenderer;
  private scene = new Scene();
  private ground: Mesh<BufferGeometry, MeshBasicMaterial> | null = null;
  private lines: LineSegments<BufferGeometry, LineBasicMaterial> | null = null;
  private darts: Markers;
  private diamonds: Markers;
  private trailLines: LineSegments<BufferGeometry, LineBasicMaterial>;
  private waves: Wave[] = [];
  private range: DepthRange | null = null;
  private width = 1;
  private height = 1;
  private viewProjection = new Matrix4();
  private matrix = new Matrix4();
  private spin = new Quaternion();
  private tilt = new Quaternion();
  private where = new Vector3();
  private size = new Vector3();

  constructor(canvas: HTMLCanvasElement) {
    this.software = rendersInSoftware();
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.software, alpha: true, powerPreference: "high-performance" });
    this.renderer.setClearColor(0, 0);
    this.controls = new MapControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.maxPolarAngle = 1.45;
    this.controls.zoomToCursor = true;
    this.darts = new Markers(this.scene, outline(DART));
    this.diamonds = new Markers(this.scene, outline(DIAMOND));
    this.trailLines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ vertexColors: true, transparent: true, depthTest: false }));
    this.trailLines.frustumCulled = false;
    this.trailLines.renderOrder = 5;
    this.scene.add(this.trailLines);
  }

  dispose() {
    this.controls.dispose();
    this.renderer.dispose();
    this.scene.traverse((thing) => { if (thing instanceof Mesh || thing instanceof LineSegments) thing.geometry.dispose(); });
  }

  resize(width: number, height: number, pixelRatio: number) {
    this.width = width;
    this.height = height;
    this.renderer.setPixelRatio(pixelRatio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  setGround(tile: TerrainTile | null, dark: boolean) {
    if (this.ground) {
      this.scene.remove(this.ground);
      this.ground.geometry.dispose();
      this.ground.material.map?.dispose();
      this.ground = null;
    }
    if (this.lines) {
      this.scene.remove(this.lines);
      this.lines.geometry.dispose();
      this.lines = null;
    }
    this.contours = null;
    this.range = tile && depthRange(tile);
    if (!tile || !this.range) return;
    this.extent_m = Math.max(tile.rows - 1, tile.columns - 1) * tile.spacing_m;
    this.stretch = exaggeration(this.extent_m, this.range.high);
    const material = new MeshBasicMaterial({ map: groundPicture(tile, this.range, this.stretch, dark), side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 4 });
    if (material.map && !this.software) material.map.anisotropy = 8;
    this.ground = new Mesh(groundGeometry(tile, this.stretch), material);
    this.scene.add(this.ground);
    this.contours = contourLines(tile, this.range);
    const { segments } = this.contours;
    const vertices = new Float32Array(segments.length);
    for (let i = 0; i < segments.length; i += 3) {
      vertices[i] = segments[i + 1];
      vertices[i + 1] = -segments[i + 2] * this.stretch + this.extent_m * 2e-4;
      vertices[i + 2] = -segments[i];
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(vertices, 3));
    this.lines = new LineSegments(geometry, new LineBasicMaterial({ color: dark ? 0xbfe0da : 0x10282f, transparent: true, opacity: dark ? 0.3 : 0.32 }));
    this.scene.add(this.lines);
  }

  /** Shows a square of this half width around a place, from the south and above. */
  look(north_m: number, east_m: number, half_m: number, polar = 0.72, azimuth = 0) {
    const fov = (this.camera.fov * Math.PI) / 360;
    const narrow = Math.min(1.25, this.camera.aspect);
    const away = (1.06 * half_m) / Math.tan(fov) / narrow;
    const ground = this.range ? -0.5 * (this.range.low + this.range.high) * this.stretch : 0;
    this.controls.target.set(east_m, ground, -north_m + 0.13 * half_m);
    const flat = away * Math.sin(polar);
    this.camera.position.set(east_m + flat * Math.sin(azimuth), ground + away * Math.cos(polar), this.controls.target.z + flat * Math.cos(azimuth));
    this.controls.minDistance = half_m / 40;
    this.controls.maxDistance = 8 * away;
    this.camera.near = away / 200;
    this.camera.far = away * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }
  zoom(factor: number) {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }
  turnTo(polar: number, azimuth: number) {
    const away = this.controls.getDistance();
    const { target } = this.controls;
    this.camera.position.set(target.x + away * Math.sin(polar) * Math.sin(azimuth), target.y + away * Math.cos(polar), target.z + away * Math.sin(polar) * Math.cos(azimuth));
    this.controls.update();
  }

  /** Metres a pixel at a place. */
  metresAPixel(x: number, y: number, z: number): number {
    this.where.set(x, y, z);
    const away = this.where.distanceTo(this.camera.position);
    return (2 * away * Math.tan((this.camera.fov * Math.PI) / 360)) / this.height;
  }

  project(north_m: number, east_m: number, down_m: number): Place {
    const e = this.viewProjection.elements;
    const x = east_m;
    const y = -down_m * this.stretch;
    const z = -north_m;
    const w = e[3] * x + e[7] * y + e[11] * z + e[15];
    return {
      x: (((e[0] * x + e[4] * y + e[8] * z + e[12]) / w) * 0.5 + 0.5) * this.width,
      y: (-((e[1] * x + e[5] * y + e[9] * z + e[13]) / w) * 0.5 + 0.5) * this.height,
      behind: w <= 0,
    };
  }

  /** Where the line of sight through a pixel meets the ground, or the depth given where no ground is; null above the horizon. */
  groundUnder(px: number, py: number, depthAt: (north: number, east: number) => number, otherwise_m: number): { north_m: number; east_m: number; depth_m: number } | null {
    const near = new Vector3((px / this.width) * 2 - 1, 1 - (py / this.height) * 2, -1).unproject(this.camera);
    const ray = new Vector3((px / this.width) * 2 - 1, 1 - (py / this.height) * 2, 1).unproject(this.camera).sub(near).normalize();
    if (ray.y > -1e-3) return null;
    const top = near.y / -ray.y;
    const bottom = this.range ? (near.y + this.range.high * this.stretch) / -ray.y : top;
    for (let i = 0; i <= 200; ++i) {
      const along = top + ((bottom - top) * i) / 200;
      const at = near.clone().addScaledVector(ray, along);
      const depth = depthAt(-at.z, at.x);
      if (-at.y / this.stretch >= depth) return { north_m: -at.z, east_m: at.x, depth_m: depth };
    }
    const at = near.clone().addScaledVector(ray, (near.y + otherwise_m * this.stretch) / -ray.y);
    return { north_m: -at.z, east_m: at.x, depth_m: NaN };
  }

  setVehicles(instant: Instant, vehicles: VehicleInfo[], chosen: number | null, accent: string, dim: string) {
    for (const [markers, fixed] of [[this.darts, false], [this.diamonds, true]] as const) {
      markers.reserve(vehicles.length);
      const [rim, fill] = markers.meshes;
      let count = 0;
      const colour = new Color();
      for (const { index, fixed: stands } of vehicles) {
        if (stands !== fixed || !instant.has(index)) continue;
        const [x, y, z] = [instant.east(index), -instant.down(index) * this.stretch, -instant.north(index)];
        const pixel = this.metresAPixel(x, y, z);
        this.spin.setFromAxisAngle(UP, fixed ? 0 : -instant.yaw(index));
        this.tilt.setFromAxisAngle(this.size.set(1, 0, 0), fixed ? 0 : instant.pitch(index));
        this.spin.multiply(this.tilt);
        const radius = (index === chosen ? 1.25 : 1) * VEHICLE_PIXELS * pixel;
        this.where.set(x, y, z);
        this.matrix.compose(this.where, this.spin, this.size.setScalar(radius * 1.3));
        rim.setMatrixAt(count, this.matrix);
        this.matrix.compose(this.where, this.spin, this.size.setScalar(radius));
        fill.setMatrixAt(count, this.matrix);
        fill.setColorAt(count, colour.set(index === chosen ? accent : instant.flags[index] & 1 ? dim : "#ffffff"));
        ++count;
      }
      for (const mesh of [rim, fill]) {
        mesh.count = count;
        mesh.instanceMatrix.needsUpdate = true;
        if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
      }
    }
  }

  setTrails(trails: Trails, now_s: number, trail_s: number, dark: boolean) {
    const { position, colour, vertices } = trails.segments(now_s, trail_s, this.stretch, dark);
    const { geometry } = this.trailLines;
    const old = geometry.getAttribute("position") as BufferAttribute | undefined;
    if (!old || old.array !== position) {
      geometry.setAttribute("position", new BufferAttribute(position, 3).setUsage(DynamicDrawUsage));
      geometry.setAttribute("color", new BufferAttribute(colour, 4).setUsage(DynamicDrawUsage));
    } else {
      old.needsUpdate = true;
      geometry.getAttribute("color").needsUpdate = true;
    }
    geometry.setDrawRange(0, vertices);
  }

  /** Fronts of packets under way; a front is a circle at the sender's depth. */
  setWaves(packets: Packet[], now_s: number, step: Step, dark: boolean) {
    const shown = packets.slice(-MOST_WAVES);
    while (this.waves.length < shown.length) this.waves.push(this.makeWave());
    this.waves.forEach(({ mesh, radii }, i) => {
      const packet = shown[i];
      mesh.visible = packet !== undefined;
      if (!packet || packet.north_m === null || packet.east_m === null || packet.down_m === null) return;
      const outer = Math.max(0, now_s - packet.depart_s) * packet.wave_speed_mps;
      const inner = Math.max(0, now_s - packet.depart_s - packet.duration_s) * packet.wave_speed_mps;
      mesh.position.set(packet.east_m, -packet.down_m * this.stretch, -packet.north_m);
      const pixel = this.metresAPixel(mesh.position.x, mesh.position.y, mesh.position.z);
      const faint = Math.max(0.15, 1 - outer / (1.6 * this.extent_m));
      radii.value.set(inner, Math.max(inner, outer - 2.2 * pixel), outer);
      mesh.material.uniforms.alpha.value.set((step.waves === "filled" ? 0.16 : 0) * faint, 0.95 * faint);
      mesh.material.uniforms.colour.value.set(dark ? "#f4fbff" : "#0b2a36");
    });
  }
  private makeWave(): Wave {
    const geometry = new BufferGeometry();
    const direction: number[] = [];
    const index: number[] = [];
    for (let i = 0; i <= WAVE_POINTS; ++i) {
      const angle = (2 * Math.PI * i) / WAVE_POINTS;
      for (let ring = 0; ring < 4; ++ring) direction.push(Math.sin(angle), ring, -Math.cos(angle));
      if (i < WAVE_POINTS) for (const ring of [0, 2]) { // the band of the packet's length, then its front
        const k = 4 * i + ring;
        index.push(k, k + 1, k + 5, k, k + 5, k + 4);
      }
    }
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(direction), 3));
    geometry.setIndex(index);
    const radii = { value: new Vector3() };
    const material = new ShaderMaterial({
      transparent: true, depthTest: false, depthWrite: false, side: DoubleSide,
      uniforms: { radii, alpha: { value: new Vector2() }, colour: { value: new Color() } },
      vertexShader: `uniform vec3 radii; uniform vec2 alpha; varying float opacity;
        void main() {
          float ring = position.y;
          float radius = ring < 0.5 ? radii.x : ring < 2.5 ? radii.y : radii.z;
          opacity = ring < 0.5 ? 0.25 * alpha.x : ring < 1.5 ? alpha.x : alpha.y;
          gl_Position = projectionMatrix * modelViewMatrix * vec4(radius * position.x, 0.0, radius * position.z, 1.0);
        }`,
      fragmentShader: `uniform vec3 colour; varying float opacity;
        void main() {
          gl_FragColor = vec4(colour, opacity);
          #include <colorspace_fragment>
        }`,
    });
    const mesh = new Mesh(geometry, material);
    mesh.frustumCulled = false;
    mesh.renderOrder = 7;
    this.scene.add(mesh);
    return { mesh, radii };
  }

  render() {
    this.camera.updateMatrixWorld();
    this.viewProjection.multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
    this.renderer.render(this.scene, this.camera);
  }
}

function rendersInSoftware(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  const more = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = more ? String(gl?.getParameter(more.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}
