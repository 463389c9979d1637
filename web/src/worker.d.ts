declare module "worker:*" {
  const code: string; // of the worker, bundled
  export default code;
}
