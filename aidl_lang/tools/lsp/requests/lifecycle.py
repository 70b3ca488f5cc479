"""Notifications of the client: folders, settings, files that have changed."""

from __future__ import annotations

import logging

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from aidl_lang.common.files import DATA, PROGRAM
from aidl_lang.tools.lsp.convert import Settings
from aidl_lang.tools.lsp.documents import path_of
from aidl_lang.tools.lsp.server import Server

_SECTION = "aidl"
log = logging.getLogger(__name__)


def register_lifecycle(server: Server) -> None:
    @server.feature(types.INITIALIZE)
    def initialize(params: types.InitializeParams) -> None:
        _take_roots(server)
        _use(server, Settings.read(params.initialization_options))

    @server.feature(types.INITIALIZED)
    async def initialized(params: types.InitializedParams) -> None:
        server.runner.warm_up()
        await _watch_files(server)
        await _ask_settings(server)

    @server.feature(types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
    def folders(params: types.DidChangeWorkspaceFoldersParams) -> None:
        _take_roots(server)

    @server.feature(types.WORKSPACE_DID_CHANGE_CONFIGURATION)
    async def configure(params: types.DidChangeConfigurationParams) -> None:
        if isinstance(params.settings, dict) and _SECTION in params.settings:
            _use_settings(server, Settings.read(params.settings[_SECTION]))
        else:
            await _ask_settings(server)

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def files(params: types.DidChangeWatchedFilesParams) -> None:
        for path in {path_of(change.uri) for change in params.changes}:
            if not server.documents.at(path):  # what is open says what the editor says
                server.runner.renew_dependents(path)


def _take_roots(server: Server) -> None:
    roots = [path_of(folder.uri) for folder in server.workspace.folders.values()]
    if not roots and server.workspace.root_uri is not None:
        roots = [path_of(server.workspace.root_uri)]
    server.open_files.roots = tuple(dict.fromkeys(roots))


async def _watch_files(server: Server) -> None:
    known = server.client_capabilities.workspace
    watching = known.did_change_watched_files if known is not None else None
    if watching is None or not watching.dynamic_registration:
        return
    suffixes = ",".join(suffix.removeprefix(".") for suffix in (PROGRAM, *DATA))
    watcher = types.FileSystemWatcher(f"**/*.{{{suffixes}}}")
    options = types.DidChangeWatchedFilesRegistrationOptions([watcher])
    method = types.WORKSPACE_DID_CHANGE_WATCHED_FILES
    registration = types.Registration("files", method, options)
    try:
        await server.client_register_capability_async(types.RegistrationParams([registration]))
    except JsonRpcException as reason:
        log.warning("the client does not watch files: %s", reason)


async def _ask_settings(server: Server) -> None:
    known = server.client_capabilities.workspace
    if known is None or not known.configuration:
        return
    wanted = types.ConfigurationParams([types.ConfigurationItem(section=_SECTION)])
    try:
        said = await server.workspace_configuration_async(wanted)
    except JsonRpcException as reason:
        log.warning("the client tells no settings: %s", reason)
        return
    _use_settings(server, Settings.read(said[0] if said else None))


def _use_settings(server: Server, settings: Settings) -> None:
    if settings != server.settings:
        _use(server, settings)
        server.refresh_hints()


def _use(server: Server, settings: Settings) -> None:
    server.settings, server.runner.delay = settings, settings.delay
