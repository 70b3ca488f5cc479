export default function load(): Promise<any>;
