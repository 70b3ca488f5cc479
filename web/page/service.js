/** Keeps the playground for when there is no connection. The list of its files and their digest are put in by the build. */

const VERSION = "{{version}}";
const FILES = /** @type {string[]} */ (JSON.parse('{{files}}'));
const PYTHON = "{{python}}";
const NAME = "aidl-playground-";

const worker = /** @type {any} */ (self);

worker.addEventListener("install", (/** @type {any} */ event) => {
  event.waitUntil(caches.open(NAME + VERSION).then((cache) => cache.addAll(FILES)));
});

worker.addEventListener("activate", (/** @type {any} */ event) => {
  const old = caches.keys().then((names) => names.filter((name) => name.startsWith(NAME) && name !== NAME + VERSION));
  event.waitUntil(old.then((names) => Promise.all(names.map((name) => caches.delete(name)))).then(() => worker.clients.claim()));
});

worker.addEventListener("fetch", (/** @type {any} */ event) => {
  const { request } = event;
  const isOurs = request.url.startsWith(worker.registration.scope) || request.url.startsWith(PYTHON);
  if (request.method === "GET" && isOurs) event.respondWith(answer(request));
});

/** @param {Request} request */
async function answer(request) {
  const cache = await caches.open(NAME + VERSION);
  const known = await cache.match(request, { ignoreSearch: true });
  if (known) return known;
  const found = await fetch(request);
  if (found.ok && found.type !== "opaque") await cache.put(request, found.clone());
  return found;
}
